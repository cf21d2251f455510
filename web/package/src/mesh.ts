// A mesh image: the meshes of all levels with their pixel maps.
import type { NamedFile, SaveOptions } from "./container.js";
import type { EngineMesh } from "./engine.js";
import type { TextFormat } from "./export.js";
import type { Comparison, DrawMode, MeshFacts, Pixels, Quality } from "./types.js";

/**
 * A mesh image. Positions are in pixels: (0, 0) is the centre of the top left pixel, x grows to the right, y
 * down. Arrays are copies. A mesh lives in the engine's memory until free() is called.
 */
export class Mesh {
  /** For the other classes of this package. */
  readonly handle: EngineMesh;

  constructor(handle: EngineMesh) {
    this.handle = handle;
  }

  facts(): MeshFacts {
    return this.handle.facts();
  }

  /** x and y of every vertex. */
  positions(level = 0): Float32Array {
    return this.handle.positions(level);
  }

  /** Three vertices of every face, counter-clockwise as seen on screen. */
  faces(level = 0): Uint32Array {
    return this.handle.faces(level);
  }

  /** Two vertices of every edge, each edge once. */
  edges(level = 0): Uint32Array {
    return this.handle.edges(level);
  }

  /** Colour of every vertex: L*, u*, v*, and alpha where the mesh has it. */
  features(level = 0): Float32Array {
    return this.handle.features(level);
  }

  /** The face of every pixel, row by row; 4294967295 outside the mask. */
  faceIds(level = 0): Uint32Array {
    return this.handle.faceIds(level);
  }

  /** Weights of the second and third corner of every pixel; that of the first is 1 less both. */
  barycentrics(level = 0): Float32Array {
    return this.handle.barycentrics(level);
  }

  /** Draws a level. Only gouraud, wire and flat have a scale other than 1. */
  draw(mode: DrawMode = "map", level = 0, scale = 1): Pixels {
    return this.handle.draw(mode, level, scale);
  }

  /** The mesh as an SVG document; gradient gives each face a linear gradient. */
  svg(mode: "flat" | "wire" | "gradient" = "flat", level = 0): string {
    return this.handle.svg(mode, level);
  }

  /**
   * Saves a container, or a plain glTF asset; the file `name` comes first. Where savesWithDraco() says so,
   * loadDraco() must have finished before.
   */
  save(options: SaveOptions): NamedFile[] {
    return this.handle.save(options);
  }

  /** A level as a text file of another program; `image` is the file that a sprite names. */
  exportText(format: TextFormat, level = 0, image = "image.png"): string {
    return this.handle.exportText(format, level, image);
  }

  /**
   * A level as NAME.obj, NAME.mtl and NAME-texture.png (or .jpg) under a picture: the bytes of a PNG or JPEG of the
   * image, or those that the container came with.
   */
  exportTextured(name: string, level = 0, texture?: Uint8Array): NamedFile[] {
    return this.handle.exportTextured(name, level, texture);
  }

  quality(level = 0): Quality {
    return this.handle.quality(level);
  }

  /** Errors of the reconstruction against pixels of the same size. */
  compare(pixels: Pixels, level = 0): Comparison {
    return this.handle.compare(pixels, level);
  }

  /** Gives the memory back. The mesh must not be used afterwards. */
  free(): void {
    this.handle.delete();
  }
}
