// Segmentation: the cells of a mesh, the order in which they merge, and drawings of regions made of them.
import type { Engine, EngineObject } from "./engine.js";
import type { Mesh } from "./mesh.js";
import { Regions, type SegmentationData } from "./regions.js";
import type { Pixels } from "./types.js";

export interface SegmentOptions {
  /** default measures contours twice, with texture; fast once. */
  quality?: "default" | "fast";
  /** contour is the default; paper merges by mean colours alone. */
  distance?: "contour" | "paper";
  /** Regions of similar size that follow edges, so many of them. They become the cells. */
  superpixels?: number;
  /** Of superpixels: rounder where it is higher; 4 without it. */
  compactness?: number;
  /** No region has fewer pixels, except islands of a mask. */
  minSize?: number;
  /** Of the pyramid; 0 is the finest. */
  level?: number;
  onProgress?: (fraction: number, stage: string) => void;
}

export interface SegmentFacts {
  width: number;
  height: number;
  cells: number;
  /** How many merges the default threshold does; 0 for superpixels. */
  merges: number;
  forced: number;
  /** Why there are not as many superpixels as wanted; empty if there are. */
  missed: string;
}

export interface RegionFacts {
  pixels: number;
  /** Mean L*, u* and v*. */
  luv: [number, number, number];
  /** Left, top, right and bottom pixel. */
  box: [number, number, number, number];
  neighbors: { region: number; length: number }[];
}

/** A pixel, or the corners of a line through pixels: the first is (0, 0). */
export type SeedLine = readonly { x: number; y: number }[];

export interface ContourMap {
  /** 2 * the image's width + 1, and the same of its height. */
  width: number;
  height: number;
  data: Float32Array;
}

export interface EngineSegmentation extends EngineObject {
  facts(): SegmentFacts;
  cells(): Uint32Array;
  merges(): Uint32Array;
  heights(): Float32Array;
  borders(): Uint32Array;
  sums(): Float64Array;
  faceRegions(table: Uint32Array): Uint32Array;
  regions(table: Uint32Array): RegionFacts[];
  draw(what: string, table: Uint32Array): Pixels;
  svg(table: Uint32Array, tolerance: number): string;
  contours(): ContourMap;
  mask(table: Uint32Array, keep: readonly SeedLine[], drop: readonly SeedLine[]): Uint8Array;
  maskPng(table: Uint32Array, keep: readonly SeedLine[], drop: readonly SeedLine[]): Uint8Array;
  pieces(table: Uint32Array): Uint8Array;
  contourFile(name: string): Uint8Array;
}

declare module "./engine.js" {
  interface Engine {
    segment(
      mesh: import("./engine.js").EngineMesh,
      level: number,
      pixels: Pixels | null,
      options: object,
      progress: ((fraction: number, stage: string) => void) | null,
    ): EngineSegmentation;
  }
}

/**
 * All segmentations of one mesh at once. A `table` is the region of every cell, such as Regions.table; regions are
 * numbered by their first cells. Lives in the engine's memory until free() is called.
 */
export class Segmentation {
  private readonly handle: EngineSegmentation;

  constructor(handle: EngineSegmentation) {
    this.handle = handle;
  }

  facts(): SegmentFacts {
    return this.handle.facts();
  }

  /** Cells, merges and borders as plain arrays. */
  data(): SegmentationData {
    const { width, height, cells: count, forced } = this.handle.facts();
    return {
      width, height, count, forced,
      cells: this.handle.cells(),
      merges: this.handle.merges(),
      heights: this.handle.heights(),
      borders: this.handle.borders(),
      sums: this.handle.sums(),
    };
  }

  /** The regions of the default threshold; all others, and edits, are a call of their methods away. */
  regions(): Regions {
    return new Regions(this.data(), this.facts().merges);
  }

  /** Pixels, mean colour, box and neighbours of every region. */
  regionFacts(table: Uint32Array): RegionFacts[] {
    return this.handle.regions(table);
  }

  /** outlines: the image with lines; flat: mean colours; colors: colours that tell neighbours apart. */
  draw(what: "outlines" | "flat" | "colors", table: Uint32Array): Pixels {
    return this.handle.draw(what, table);
  }

  /** Regions as shapes that share their borders, at most `tolerance` pixels (0 to 0.5) off the pixels' edges. */
  svg(table: Uint32Array, tolerance = 0.5): string {
    return this.handle.svg(table, tolerance);
  }

  /** Between two pixels, the threshold at which their regions become one (docs/segment.md). */
  contours(): ContourMap {
    return this.handle.contours();
  }

  /** The region of every face of the mesh; 4294967295 for a face far from all pixels. */
  faceRegions(table: Uint32Array): Uint32Array {
    return this.handle.faceRegions(table);
  }

  /**
   * Chooses an object by pixels inside it and around it, as imgmesh-segment --mask does: 1 for every pixel of it.
   * With one kind alone the regions of `table` count. Throws ImgmeshError where no pixel is kept.
   */
  mask(table: Uint32Array, keep: readonly SeedLine[], drop: readonly SeedLine[]): Uint8Array {
    return this.handle.mask(table, keep, drop);
  }

  /** The same as a .png, white inside and black outside. */
  maskPng(table: Uint32Array, keep: readonly SeedLine[], drop: readonly SeedLine[]): Uint8Array {
    return this.handle.maskPng(table, keep, drop);
  }

  /** The mesh in pieces as a .glb: a primitive and a material region-<number> for every region with faces. */
  pieces(table: Uint32Array): Uint8Array {
    return this.handle.pieces(table);
  }

  /** The contour map as the file `name`: .npy, or .mat for the benchmark of BSDS500. */
  contourFile(name: string): Uint8Array {
    return this.handle.contourFile(name);
  }

  free(): void {
    this.handle.delete();
  }
}

/** Cuts a mesh into cells and merges them; colours are those of `pixels`, or of the reconstruction without them. */
export function segmentMesh(engine: Engine, mesh: Mesh, pixels: Pixels | null, options: SegmentOptions): Segmentation {
  return new Segmentation(engine.segment(mesh.handle, options.level ?? 0, pixels, options, options.onProgress ?? null));
}
