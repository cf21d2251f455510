// Values that the package takes and gives.

/** An image as ImageData has it: 4 bytes a pixel, R, G, B and A in sRGB, not premultiplied by A. */
export interface Pixels {
  width: number;
  height: number;
  data: Uint8ClampedArray | Uint8Array;
}

/** What a build may be told: `preset`, and every parameter of docs/parameters.md by its name. */
export interface BuildParameters {
  preset?: "fast" | "default" | "best" | "max" | "small" | "fem";
  vertices?: number;
  density?: number;
  faces?: number;
  levels?: number;
  "shape-weight"?: number;
  "map-smoothness"?: number;
  [name: string]: string | number | boolean | readonly number[] | undefined;
}

export interface BuildOptions {
  /** What alpha means; auto (the default) keeps soft alpha as a channel and cuts out where it is a mask. */
  alpha?: "auto" | "keep" | "cut" | "ignore";
  /** Pixels with at least this alpha, above 0 to 1, are inside. */
  alphaThreshold?: number;
  /** Is called now and then with the fraction done and the name of the stage. */
  onProgress?: (fraction: number, stage: string) => void;
}

/** One parameter of a build, as docs/parameters.md lists it. */
export interface Parameter {
  name: string;
  group: string;
  help: string;
  default: string;
  words?: string[];
}

export interface LevelFacts {
  vertices: number;
  faces: number;
  /** RMS error of the reconstruction in L*u*v*, of a mesh that was built here. */
  rms?: number;
  /** The same of the mesh drawn without its pixel map. */
  meshRms?: number;
}

export interface MeshFacts {
  width: number;
  height: number;
  hasMask: boolean;
  /** The channels that the mesh is made of, by their names in the file. */
  channels: string[];
  /** Whether features begin with a colour, L*, u* and v*. */
  hasColor: boolean;
  /** The feature that is alpha, or -1. */
  alphaFeature: number;
  generator: string;
  /** Level 0 is the finest. */
  levels: LevelFacts[];
  parameters: Record<string, string | number | boolean>;
  /** What a reader of a report should know, a line each. */
  warnings: string[];
}

export interface Quality {
  /** Faces that are turned over: 0 in every mesh that was built. */
  flippedFaces: number;
  /** Triangles between neighbouring pixels that the pixel map turns over. */
  flippedPixelTriangles: number;
  /** Mean shape of the faces, 1 for equilateral ones. */
  meanShape: number;
  /** The smallest angle, in degrees. */
  minAngle: number;
  /** How far pixels lie from their own places, in pixels. */
  meanDisplacement: number;
}

export interface Comparison {
  rmsLuv: number;
  rmsRgb: number;
  /** In dB; Infinity for equal images. */
  psnr: number;
  ssim: number;
}

/**
 * map: the reconstruction through the pixel map; gouraud: colours interpolated over the faces; wire: edges;
 * patches: the pixels of each face in one colour; flat: each face in one colour; visits: where the collapse
 * was busy.
 */
export type DrawMode = "map" | "gouraud" | "wire" | "patches" | "flat" | "visits";

/** What the engine throws: an Error with the name ImgmeshError and a kind. */
export interface ImgmeshError extends Error {
  name: "ImgmeshError";
  kind: "argument" | "io" | "file" | "unsupported" | "memory" | "internal";
}

/** Whether something that was caught is an error of the engine. */
export function isImgmeshError(error: unknown): error is ImgmeshError {
  return error instanceof Error && error.name === "ImgmeshError";
}
