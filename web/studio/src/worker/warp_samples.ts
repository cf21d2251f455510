// The pixel maps at every n-th pixel, for drawing a warped image as a grid of triangles.
import type { Mesh } from "imgmesh.wasm";

export const kOutside = 0xffffffff;
/** Pixels beside a mask move as the next one inside does, this far: there the image's edge is soft. */
const kRim = 4;

export interface SampledMaps {
  width: number;
  height: number;
  /** Pixels between samples. The last column and row are those of the image. */
  step: number;
  columns: number;
  rows: number;
  /** Of every level: the face of every sample, or kOutside; the weights of its second and third corner. */
  levels: { faces: Uint32Array; weights: Float32Array; corners: Uint32Array; vertices: number }[];
}

/** Samples of all levels, at most `most` of each. */
export function sampledMaps(mesh: Mesh, most: number): SampledMaps {
  const { width, height, levels, hasMask } = mesh.facts();
  const kLongest = 4096; // the side of a texture
  const step = Math.max(1, Math.ceil(Math.sqrt((width * height) / most)), Math.ceil(Math.max(width, height) / kLongest));
  const columns = Math.ceil((width - 1) / step) + 1, rows = Math.ceil((height - 1) / step) + 1;
  return {
    width, height, step, columns, rows,
    levels: levels.map(({ vertices }, level) => {
      const ids = mesh.faceIds(level), all = mesh.barycentrics(level);
      const faces = new Uint32Array(columns * rows), weights = new Float32Array(2 * columns * rows);
      for (let r = 0, s = 0; r < rows; ++r)
        for (let c = 0; c < columns; ++c, ++s) {
          const pixel = Math.min(r * step, height - 1) * width + Math.min(c * step, width - 1);
          faces[s] = ids[pixel]!;
          weights[2 * s] = all[2 * pixel]!;
          weights[2 * s + 1] = all[2 * pixel + 1]!;
        }
      if (hasMask) for (let ring = 0; ring < Math.max(1, Math.ceil(kRim / step)); ++ring) grow(faces, weights, columns, rows);
      return { faces, weights, corners: mesh.faces(level), vertices };
    }),
  };
}

/** Gives samples outside that touch one inside its face and weights. */
function grow(faces: Uint32Array, weights: Float32Array, columns: number, rows: number): void {
  const before = faces.slice();
  for (let r = 0, s = 0; r < rows; ++r)
    for (let c = 0; c < columns; ++c, ++s) {
      if (before[s] !== kOutside) continue;
      for (const [dc, dr] of [[-1, 0], [1, 0], [0, -1], [0, 1], [-1, -1], [1, -1], [-1, 1], [1, 1]] as const) {
        if (c + dc < 0 || c + dc >= columns || r + dr < 0 || r + dr >= rows) continue;
        const other = s + dr * columns + dc;
        if (before[other] === kOutside) continue;
        faces[s] = before[other]!;
        weights[2 * s] = weights[2 * other]!;
        weights[2 * s + 1] = weights[2 * other + 1]!;
        break;
      }
    }
}
