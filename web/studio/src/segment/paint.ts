// Regions as they are seen at any zoom: for each pixel of the screen the region below it. What it costs depends on
// the screen alone, not on the image.
import type { SegmentationData } from "imgmesh.wasm";

/** Colours are R, G, B and A from the lowest byte on, as ImageData has them on all machines of today. */
export interface RegionLook {
  /** The region of every cell. */
  table: Uint32Array;
  /** What lies over the image, for every cell. */
  fill: Uint32Array;
  /** Regions with lines of another colour around them: 1. */
  marked: Uint8Array;
}

/** A box of the screen in device pixels, and the image's pixels there. */
export interface Window {
  width: number;
  height: number;
  /** The image's column and row below each pixel of the screen, and one more. */
  columns: Int32Array;
  rows: Int32Array;
}

// Light and dark side by side are seen on any image.
const kLight = 0xff5ad8ff, kDark = 0x90000000, kMark = 0xffffffff, kMarkDark = 0xffb36a00;
const kOutside = 0xffffffff;

export function paintRegions(out: Uint32Array, { width, height, columns, rows }: Window, data: SegmentationData, look: RegionLook): void {
  const { cells, width: stride } = data, { table, fill, marked } = look;
  // Regions of this row and of the next, one pixel longer; -1 outside the mask.
  let above = new Int32Array(width + 1), now = new Int32Array(width + 1), below = new Int32Array(width + 1);
  const read = (row: Int32Array, y: number): void => {
    const start = y * stride;
    for (let x = 0; x <= width; ++x) {
      const cell = cells[start + columns[x]!]!;
      row[x] = cell === kOutside ? -1 : table[cell]!;
    }
  };
  read(now, rows[0]!);
  above.set(now);
  for (let y = 0; y < height; ++y) {
    if (rows[y + 1] === rows[y]) below.set(now);
    else read(below, rows[y + 1]!);
    const start = rows[y]! * stride, at = y * width;
    let left = now[0]!;
    for (let x = 0; x < width; ++x) {
      const region = now[x]!, right = now[x + 1]!, under = below[x]!, over = above[x]!;
      let color: number;
      if (region !== right || region !== under) {
        const other = region !== right ? right : under;
        color = marked[region] === 1 || marked[other] === 1 ? kMark : kLight;
      } else if (region !== left || region !== over) {
        const other = region !== left ? left : over;
        color = marked[region] === 1 || marked[other] === 1 ? kMarkDark : kDark;
      } else {
        color = region < 0 ? 0 : fill[cells[start + columns[x]!]!]!;
      }
      out[at + x] = color;
      left = region;
    }
    [above, now, below] = [now, below, above];
  }
}
