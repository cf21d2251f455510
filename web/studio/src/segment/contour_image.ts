// The contour map as an image: the stronger a contour, the darker.
import type { ContourMap } from "imgmesh.wasm";

/** A contour of this height is half as dark as can be: the default threshold. */
const kHalf = 8;

/** Draws the map at the image's size: each pixel has the higher of its contours to the right and below. */
export function contourImage(map: ContourMap): Promise<ImageBitmap> {
  const width = (map.width - 1) / 2, height = (map.height - 1) / 2;
  const image = new ImageData(width, height), codes = new Uint32Array(image.data.buffer);
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) {
      const at = (2 * y + 1) * map.width + 2 * x + 1;
      const contour = Math.max(map.data[at + 1]!, map.data[at + map.width]!);
      const code = contour === Infinity ? 0 : Math.round(255 * (1 - contour / (contour + kHalf)));
      codes[y * width + x] = (0xff000000 | (code << 16) | (code << 8) | code) >>> 0;
    }
  return createImageBitmap(image);
}
