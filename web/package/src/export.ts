// Files for other programs.
import type { NamedFile } from "./container.js";
import type { Pixels } from "./types.js";

declare module "./engine.js" {
  interface Engine {
    encodePng(pixels: Pixels): Uint8Array;
    exportLabels(name: string, width: number, height: number, labels: Uint32Array): Uint8Array;
  }
  interface EngineMesh {
    exportText(format: string, level: number, image: string): string;
    exportTextured(name: string, level: number, texture: Uint8Array | undefined): NamedFile[];
  }
}

/** Text files of imgmesh-convert, in the same bytes. */
export type TextFormat =
  /** PLY with colours. */
  | "ply"
  /** Wavefront OBJ with colours. */
  | "obj"
  /** TexturePacker's JSON of a sprite, as PixiJS reads it. */
  | "json";
