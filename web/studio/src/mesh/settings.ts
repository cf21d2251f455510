// What a build is told, as the controls have it.
import type { BuildOptions, BuildParameters, Pixels } from "imgmesh.wasm";

export type PresetName = "default" | "fast" | "best" | "small" | "fem";

/** Presets in plain words, with the values that their sliders start from. */
export const kPresets: readonly {
  id: PresetName;
  label: string;
  help: string;
  shape: number | null;
  smoothness: number;
}[] = [
  { id: "default", label: "Balanced", help: "A low error, with triangles of good shape.", shape: 0.22, smoothness: 20 },
  { id: "fast", label: "Fast", help: "The shortest time; corners are not moved afterwards.", shape: null, smoothness: 20 },
  { id: "best", label: "Lowest error", help: "The lowest error, whatever the triangles look like. Takes several times as long.", shape: 0, smoothness: 20 },
  { id: "small", label: "Smallest file", help: "The fewest bytes, for a few percent more error.", shape: 0.22, smoothness: 20 },
  { id: "fem", label: "For simulation", help: "No triangle of bad shape, for numerical simulation. Takes several times as long.", shape: 0.3, smoothness: 20 },
];

export type AlphaUse = NonNullable<BuildOptions["alpha"]>;

export const kAlphaUses: readonly { id: AlphaUse; label: string; help: string }[] = [
  { id: "auto", label: "Automatic", help: "Soft transparency is kept; where it only cuts out, it is a mask." },
  { id: "keep", label: "Keep it soft", help: "Transparency is part of the mesh, as colour is." },
  { id: "cut", label: "Cut out", help: "Only what is opaque enough is meshed." },
  { id: "ignore", label: "Ignore it", help: "The whole rectangle is meshed by its colours." },
];

export interface Settings {
  preset: PresetName;
  /** null: 1 % of the pixels, as imgmesh-build takes where nothing is said. */
  vertices: number | null;
  /** null: as the preset has it. */
  shape: number | null;
  smoothness: number | null;
  levels: number;
  alpha: AlphaUse;
}

export const kLeastVertices = 4;

/** The vertices that a build takes where nothing is said: 1 % of the pixels. */
export function usualVertices(pixels: Pixels): number {
  return Math.max(kLeastVertices, Math.round((pixels.width * pixels.height) / 100));
}

/** The most that the slider offers: beyond, a mesh is larger than the image. */
export function mostVertices(pixels: Pixels): number {
  return Math.max(kLeastVertices + 1, Math.round((pixels.width * pixels.height) / 4));
}

export function parametersOf(settings: Settings): BuildParameters {
  const parameters: BuildParameters = {};
  if (settings.preset !== "default") parameters.preset = settings.preset;
  if (settings.vertices !== null) parameters.vertices = settings.vertices;
  if (settings.shape !== null) parameters["shape-weight"] = settings.shape;
  if (settings.smoothness !== null) parameters["map-smoothness"] = settings.smoothness;
  if (settings.levels > 1) parameters.levels = settings.levels;
  return parameters;
}

/** Whether some pixel is not opaque: only then alpha means something. */
export function hasAlpha({ data }: Pixels): boolean {
  for (let i = 3; i < data.length; i += 4) if (data[i] !== 255) return true;
  return false;
}
