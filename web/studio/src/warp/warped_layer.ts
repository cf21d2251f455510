// The warped image as a side of the view: by WebGL while the hand moves, sample by sample when it rests.
import type { Layer, Session, Studio, ViewTransform } from "../contracts";
import { bitmapOf } from "../open/bitmap";
import type { WarpEditor } from "./editor";
import { GlStage } from "./gl_stage";
import { kMostSamples, Preview } from "./preview";

/** Images up to this size are drawn exactly whenever the hand rests. */
const kExactPixels = 6e6;
/** Without WebGL, a drag shows so many pixels. */
const kCoarsePixels = 1e5;

export class WarpedLayer {
  readonly layer: Layer;
  readonly hasWebGl: boolean;
  /** How long the script of the last drawing took, in ms. */
  scriptTime = 0;
  /** Draws the wires, too, where the image is drawn by WebGL. */
  paintWires: (gl: WebGL2RenderingContext, context: CanvasRenderingContext2D, t: ViewTransform) => void = () => {};
  /** Whether they were drawn so. */
  hasWires = false;
  private readonly studio: Studio;
  private readonly editor: WarpEditor;
  private readonly session: Session;
  private readonly picture: ImageBitmap;
  private readonly stage: GlStage;
  private preview: Preview | null = null;
  private drawn: ImageBitmap | null = null;
  private drawing = false;
  private closed = false;
  /** Whether other sides will be shown: the view may still draw this one until they are there. */
  private leaving = false;

  constructor(studio: Studio, editor: WarpEditor, session: Session) {
    const { width, height } = studio.facts!;
    this.studio = studio;
    this.editor = editor;
    this.session = session;
    this.picture = studio.picture!.bitmap;
    this.stage = new GlStage(studio.view.element);
    this.hasWebGl = this.stage.gl !== null;
    this.stage.restored = () => {
      this.preview?.forget();
      studio.view.invalidate();
    };
    this.layer = { width, height, source: (context, t) => this.draw(context, t) };
  }

  /** Fetches what the drawing needs. */
  async open(): Promise<void> {
    if (!this.hasWebGl) return;
    const levels = this.studio.facts!.levels.length;
    const maps = await this.session.ask("warp.maps", { most: kMostSamples / Math.max(1, levels / 3) });
    if (this.closed) return;
    this.preview = new Preview(maps, this.picture);
    this.preview.setMoves(this.editor.moves);
    this.studio.view.invalidate();
  }

  /** Vertices have moved. */
  moved(): void {
    this.preview?.setMoves(this.editor.moves);
    if (this.preview) {
      this.drawn?.close();
      this.drawn = null;
    } else if (!this.hasWebGl) {
      void this.fetch(kCoarsePixels);
    }
    this.studio.view.invalidate();
  }

  private get isSmall(): boolean {
    return this.layer.width * this.layer.height <= kExactPixels;
  }

  /** The hand rests. */
  async rested(): Promise<void> {
    if (!this.hasWebGl || this.isSmall) await this.fetch(Infinity);
  }

  private async fetch(most: number): Promise<void> {
    if (this.drawing || this.closed) return;
    this.drawing = true;
    const moves = this.editor.moves;
    try {
      const pixels = await this.session.ask("warp.picture", Number.isFinite(most) ? { most } : {});
      const bitmap = await bitmapOf(pixels);
      if (this.closed || (this.preview && moves !== this.editor.moves)) return bitmap.close();
      this.drawn?.close();
      this.drawn = bitmap;
      this.studio.view.invalidate();
    } catch (error) {
      if (!this.closed && this.session === this.studio.session) this.studio.fail(error);
    } finally {
      this.drawing = false;
      // Without WebGL the hand has gone on in the meantime.
      if (!this.closed && !this.preview && moves !== this.editor.moves) void this.fetch(this.editor.dragging ? kCoarsePixels : Infinity);
    }
  }

  private draw(context: CanvasRenderingContext2D, t: ViewTransform): void {
    const start = performance.now(), { editor, preview, layer } = this;
    const still = editor.moves.every((moves) => moves.length === 0), gl = this.stage.gl;
    const bitmap = still ? this.picture : this.drawn;
    this.hasWires = !bitmap && !this.leaving && preview !== null && gl !== null;
    if (this.hasWires) {
      preview!.coarse = editor.dragging || this.isSmall;
      this.stage.begin(gl!, context, t, layer);
      preview!.draw(gl!, context, t);
      this.paintWires(gl!, context, t);
      // The view's canvas lies above.
      context.clearRect(0, 0, t.width, t.height);
    } else {
      this.stage.hide();
      context.imageSmoothingEnabled = t.scale * t.ratio < 3;
      context.imageSmoothingQuality = t.scale * t.ratio < 1 ? "medium" : "low";
      context.drawImage(bitmap ?? this.picture, t.x, t.y, t.scale * layer.width, t.scale * layer.height);
    }
    this.scriptTime = performance.now() - start;
  }

  show(): void {
    this.leaving = false;
  }

  /** Takes away what lies below the view, until show(). */
  hide(): void {
    this.leaving = true;
    this.hasWires = false;
    this.stage.hide();
  }

  close(): void {
    this.closed = true;
    this.preview?.close();
    this.stage.remove();
    this.drawn?.close();
    this.drawn = null;
  }
}
