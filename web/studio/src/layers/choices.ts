// What a side of the view may show, and the layers for it.
import type { Layer, Overlay, Session } from "../contracts";
import type { App } from "../app";
import type { MeshArrays } from "../worker/view";
import { bitmapOf } from "../open/bitmap";
import { facePainter } from "./gl_faces";
import { wireOverlay } from "./wire";

export type Choice = "picture" | "map" | "gouraud" | "flat" | "patches";

/** In the order of the lists; labels are plain words, and titles explain them. */
export const kChoices: readonly { id: Choice; label: string; title: string }[] = [
  { id: "picture", label: "Picture", title: "The image as it is in the file" },
  { id: "map", label: "Reconstruction", title: "The image as the mesh and its pixel map give it back" },
  { id: "gouraud", label: "Mesh", title: "The triangles alone, with colours running smoothly between corners" },
  { id: "flat", label: "Flat triangles", title: "Each triangle in one colour" },
  { id: "patches", label: "Patches", title: "The pixels that belong to each triangle, in colours that tell them apart" },
];

/** The layers of one level of one mesh, each fetched when it is wanted first. */
export class MeshLayers {
  private readonly session: Session;
  private readonly level: number;
  private readonly width: number;
  private readonly height: number;
  private readonly alphaAt: number;
  private readonly hasColor: boolean;
  private readonly layers = new Map<Choice, Promise<Layer>>();
  private readonly bitmaps: ImageBitmap[] = [];
  private arraysWanted: Promise<MeshArrays> | null = null;
  private wireWanted: Promise<Overlay> | null = null;

  constructor(app: App, session: Session, level: number) {
    const facts = app.facts!;
    this.session = session;
    this.level = level;
    this.width = facts.width;
    this.height = facts.height;
    this.alphaAt = facts.alphaFeature;
    this.hasColor = facts.hasColor;
  }

  layer(choice: Exclude<Choice, "picture">): Promise<Layer> {
    let layer = this.layers.get(choice);
    if (!layer) {
      layer = this.make(choice);
      layer.catch(() => this.layers.delete(choice));
      this.layers.set(choice, layer);
    }
    return layer;
  }

  wire(): Promise<Overlay> {
    this.wireWanted ??= this.arrays().then((arrays) => wireOverlay(arrays, this.width * this.height));
    return this.wireWanted;
  }

  /** Gives memory back. The layers must not be shown afterwards. */
  close(): void {
    for (const bitmap of this.bitmaps) bitmap.close();
  }

  private arrays(): Promise<MeshArrays> {
    this.arraysWanted ??= this.session.ask("view.arrays", { level: this.level });
    return this.arraysWanted;
  }

  private async make(choice: Exclude<Choice, "picture">): Promise<Layer> {
    const size = { width: this.width, height: this.height };
    if (this.hasColor && (choice === "gouraud" || choice === "flat")) {
      const painter = facePainter(await this.arrays(), choice === "flat", this.alphaAt);
      if (painter) return { ...size, source: painter };
    }
    const bitmap = await bitmapOf(await this.session.ask("view.draw", { mode: choice, level: this.level }));
    this.bitmaps.push(bitmap);
    return { ...size, source: bitmap };
  }
}
