// The worker's part of files: containers that are opened, and what is saved.
import { loadDraco, needsDraco, savesWithDraco } from "imgmesh.wasm";
import type { MeshFacts, NamedFile, Pixels, SaveOptions, TextFormat } from "imgmesh.wasm";
import type { MethodTable, WorkerState } from "../contracts";

/** What is put on the meshes: the image as a PNG without loss, or bytes of a PNG or JPEG. */
export type TextureChoice = "png" | Uint8Array;

declare module "../contracts" {
  interface Methods {
    /** Opens a container in place of pixels; `pixels` is its reconstruction, null where it has no colour. */
    "export.open": { args: { files: NamedFile[] }; result: { facts: MeshFacts; pixels: Pixels | null } };
    "export.container": {
      args: { options: Omit<SaveOptions, "texture">; texture?: TextureChoice };
      result: NamedFile[];
    };
    "export.text": { args: { format: TextFormat; level: number; image: string }; result: string };
    "export.svg": { args: { shading: "flat" | "gradient" | "wire"; level: number }; result: string };
    "export.obj": { args: { name: string; level: number; texture: TextureChoice }; result: NamedFile[] };
    /** The image, or the reconstruction of a level, as a PNG. */
    "export.png": { args: { of: "image" | "reconstruction"; level: number }; result: Uint8Array };
  }
}

export function methods(state: WorkerState): MethodTable<"export"> {
  const mesh = () => {
    if (!state.mesh) throw new Error("there is no mesh yet");
    return state.mesh;
  };
  const image = (): Pixels => state.pixels ?? mesh().draw();
  const bytesOf = (texture: TextureChoice): Uint8Array =>
    texture === "png" ? state.imgmesh.encodePng(image()) : texture;
  return {
    async "export.open"({ files }) {
      if (needsDraco(files)) await loadDraco();
      const opened = state.imgmesh.open(files);
      state.mesh?.free();
      state.mesh = opened;
      state.pixels = null;
      const facts = opened.facts();
      return { facts, pixels: facts.hasColor ? opened.draw() : null };
    },
    async "export.container"({ options, texture }, report) {
      report(0, "saving");
      if (savesWithDraco(options)) await loadDraco();
      return mesh().save(texture ? { ...options, texture: bytesOf(texture) } : options);
    },
    "export.text": ({ format, level, image: name }) => mesh().exportText(format, level, name),
    "export.svg": ({ shading, level }) => mesh().svg(shading, level),
    "export.obj": ({ name, level, texture }) => mesh().exportTextured(name, level, bytesOf(texture)),
    "export.png": ({ of, level }) => state.imgmesh.encodePng(of === "image" ? image() : mesh().draw("map", level)),
  };
}
