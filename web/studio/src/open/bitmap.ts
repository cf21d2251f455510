// Pixels as a canvas draws them.
import type { Pixels } from "../contracts";

/** Returns pixels as a bitmap; those of a typed array of its own are not copied. */
export function bitmapOf(pixels: Pixels): Promise<ImageBitmap> {
  const data = pixels.data;
  const view = new Uint8ClampedArray(data.buffer as ArrayBuffer, data.byteOffset, data.byteLength);
  return createImageBitmap(new ImageData(view, pixels.width, pixels.height), { premultiplyAlpha: "default" });
}
