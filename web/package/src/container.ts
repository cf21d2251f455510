// Containers: the files of imgmesh-build, opened and saved.
import type { EngineMesh as OpenedMesh } from "./engine.js";

export interface NamedFile {
  /** Without a folder. */
  name: string;
  bytes: Uint8Array;
}

export interface SaveOptions {
  /** NAME.glb, one file, or NAME.gltf, which has others beside it. */
  name: string;
  /**
   * How the pixel maps are stored: "exr", which other programs read; "compact", a sixth of the bytes; or "none", a
   * plain glTF asset for engines, which imgmesh cannot open. Unless it is said: as the mesh was opened, else "exr".
   */
  layers?: "exr" | "compact" | "none";
  /** Compression of the meshes. Unless it is said: as the mesh was opened, else "edgebreaker"; "none" without maps. */
  draco?: "edgebreaker" | "sequential" | "none";
  /** The bytes of a PNG or JPEG of the image, put on the meshes for engines and viewers. Not with compact layers. */
  texture?: Uint8Array;
}

declare module "./engine.js" {
  interface Engine {
    open(files: NamedFile[]): OpenedMesh;
  }
  interface EngineMesh {
    save(options: SaveOptions): NamedFile[];
  }
}

/** Whether open() needs Draco for these files: whether one of them names its extension. */
export function needsDraco(files: readonly NamedFile[]): boolean {
  return files.some(({ name, bytes }) => {
    if (!/\.(glb|gltf)$/i.test(name)) return false;
    // The text of a .glb comes before its binary data, after 12 bytes and its own length.
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    const glb = bytes.length >= 20 && view.getUint32(0, true) === 0x46546c67;
    const text = glb ? bytes.subarray(20, 20 + view.getUint32(12, true)) : bytes;
    return new TextDecoder().decode(text).includes("KHR_draco_mesh_compression");
  });
}

/** Whether save() needs Draco with these options, of a mesh that has been built or opened. */
export function savesWithDraco(options: SaveOptions): boolean {
  return options.draco ? options.draco !== "none" : options.layers !== "none";
}
