// Edits of a mesh: how far vertices and pixels move, and the image that comes of it.
import type { EngineMesh, EngineObject } from "./engine.js";
import type { Imgmesh } from "./imgmesh.js";
import { Mesh } from "./mesh.js";
import type { Pixels } from "./types.js";

/** Vertices, as docs/warp.md describes them: exactly one of the members. */
export interface VertexSelection {
  vertex?: number;
  vertices?: number[];
  near?: [number, number];
  circle?: [number, number, number];
  beyond?: [number, number, number];
  box?: [number, number, number, number];
  border?: true;
}

export interface WarpHandle extends VertexSelection {
  /** Right and down, in pixels. */
  move?: [number, number];
  /** Degrees, counter-clockwise. */
  rotate?: number;
  scale?: number | [number, number];
  center?: [number, number];
}

/** direct: only the handles move; arap: the rest follows, as rigid as possible; injective: and no face turns over. */
export type WarpSolver = "direct" | "arap" | "injective";

export interface WarpEdit {
  name?: string;
  level?: number;
  solver?: WarpSolver;
  handles: WarpHandle[];
  pins?: VertexSelection[];
}

/** What imgmesh-warp --edits reads, as JSON. */
export interface WarpEdits {
  edits: WarpEdit[];
}

/** Values of 32-bit floats for every pixel, the channels interleaved. */
export interface FloatMap {
  width: number;
  height: number;
  channels: string[];
  data: Float32Array;
}

interface EngineWarp extends EngineObject {
  solve(edits: string, drag: boolean): string[];
  moves(level: number): Float32Array;
  places(level: number): Float32Array;
  turnedFaces(level: number): Uint32Array;
  foldedPixels(): Uint32Array;
  picture(pixels: Pixels, width: number, height: number): Pixels;
  displacement(): FloatMap;
  stMap(pixels: Pixels | null): FloatMap;
  displacementExr(): Uint8Array;
  stMapExr(pixels: Pixels | null): Uint8Array;
  warpedMesh(): EngineMesh;
}

declare module "./engine.js" {
  interface Engine {
    warpSession(mesh: EngineMesh): EngineWarp;
  }
}

/**
 * Edits of one mesh. What has been solved is kept, so that a drag costs one step of a solver. It lives in the
 * engine's memory until free() is called, and so does its mesh.
 */
export class WarpSession {
  private readonly handle: EngineWarp;

  constructor(imgmesh: Imgmesh, mesh: Mesh) {
    this.handle = imgmesh.engine.warpSession(mesh.handle);
  }

  /**
   * Solves all edits, as imgmesh-warp does. With `drag`, in the middle of a drag, it takes a few steps from
   * where the last call ended, so vertices may lag behind a little. Returns a line for each level where a
   * handle could not get where it should. Throws ImgmeshError for edits that are not as they must be, and
   * keeps the moves then.
   */
  solve(edits: WarpEdits | string, drag = false): string[] {
    return this.handle.solve(typeof edits === "string" ? edits : JSON.stringify(edits), drag);
  }

  /** x and y of the move of every vertex by its own level's edits; empty if none moves. */
  moves(level = 0): Float32Array {
    return this.handle.moves(level);
  }

  /** x and y of every vertex in the warped image: the edits of all levels count. */
  places(level = 0): Float32Array {
    return this.handle.places(level);
  }

  /** The faces that turn over or lose their area. */
  turnedFaces(level = 0): Uint32Array {
    return this.handle.turnedFaces(level);
  }

  /** The pixels, row by row from 0, where the warped image folds. */
  foldedPixels(): Uint32Array {
    return this.handle.foldedPixels();
  }

  /** Draws the warped image, of the image's size or another. The same samples as imgmesh-warp's. */
  picture(pixels: Pixels, size?: { width: number; height: number }): Pixels {
    return this.handle.picture(pixels, size?.width ?? 0, size?.height ?? 0);
  }

  /** How far each pixel moves: displacement.x to the right and displacement.y down, in pixels. */
  displacement(): FloatMap {
    return this.handle.displacement();
  }

  /** The STMap of the warped image (docs/warp.md): R, G and A. Alpha of the pixels counts where they are given. */
  stMap(pixels: Pixels | null = null): FloatMap {
    return this.handle.stMap(pixels);
  }

  /** The file of displacement(): a part of imgmesh-warp --displacement. */
  displacementExr(): Uint8Array {
    return this.handle.displacementExr();
  }

  /** The file of stMap(). */
  stMapExr(pixels: Pixels | null = null): Uint8Array {
    return this.handle.stMapExr(pixels);
  }

  /** The mesh with its vertices moved, to be saved. Throws an ImgmeshError of kind unsupported where a face would turn over. */
  warpedMesh(): Mesh {
    return new Mesh(this.handle.warpedMesh());
  }

  free(): void {
    this.handle.delete();
  }
}
