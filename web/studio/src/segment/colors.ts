// Colours of regions on the screen. Files have those of the engine.
import type { Regions } from "imgmesh.wasm";

/** Packs a colour as ImageData has it, read as one number. */
export function packed(r: number, g: number, b: number, alpha: number): number {
  return ((alpha << 24) | (b << 16) | (g << 8) | r) >>> 0;
}

const kWhiteU = 0.19783, kWhiteV = 0.46834;

/** L*u*v* to sRGB codes. */
export function rgbOf(l: number, u: number, v: number): [number, number, number] {
  if (!(l > 0)) return [0, 0, 0];
  const y = l > 8 ? ((l + 16) / 116) ** 3 : (l * 27) / 24389;
  const up = u / (13 * l) + kWhiteU, vp = v / (13 * l) + kWhiteV;
  const x = (9 * y * up) / (4 * vp), z = (y * (12 - 3 * up - 20 * vp)) / (4 * vp);
  const code = (c: number): number => {
    const clipped = Math.min(Math.max(c, 0), 1);
    return Math.round(255 * (clipped <= 0.0031308 ? 12.92 * clipped : 1.055 * clipped ** (1 / 2.4) - 0.055));
  };
  return [
    code(3.24096994 * x - 1.53738318 * y - 0.49861076 * z),
    code(-0.96924364 * x + 1.8759675 * y + 0.04155506 * z),
    code(0.05563008 * x - 0.20397696 * y + 1.05697151 * z),
  ];
}

/** A colour for each region that stays with its first cell, so that it does not flicker while the slider moves. */
export function steadyColors(regions: Regions, alpha: number): Uint32Array {
  const colors = new Uint32Array(regions.count), seen = new Uint8Array(regions.count);
  for (let cell = 0; cell < regions.table.length; ++cell) {
    const region = regions.table[cell]!;
    if (seen[region]) continue;
    seen[region] = 1;
    const hue = (cell * 0.61803398875) % 1, tone = (cell * 0.7548776662) % 1;
    const wave = (shift: number): number => 0.5 + 0.5 * Math.cos(2 * Math.PI * (hue - shift));
    const light = 90 + 70 * tone;
    colors[region] = packed(light * 0.6 + 110 * wave(0), light * 0.6 + 110 * wave(1 / 3), light * 0.6 + 110 * wave(2 / 3), alpha);
  }
  return colors;
}

/** Each region's mean colour. */
export function meanColors(regions: Regions): Uint32Array {
  const means = regions.means();
  return Uint32Array.from({ length: regions.count }, (_, r) => packed(...rgbOf(means[4 * r + 1]!, means[4 * r + 2]!, means[4 * r + 3]!), 255));
}
