// Image files as pictures.
import type { Picture } from "../contracts";
import { readPixels } from "./read_pixels";

/** What fits into the 4 GB that the engine can have: it takes 105 bytes a pixel, and more with alpha. */
export const kLargestPixels = 32e6;

/**
 * Decodes what the browser knows: turned as EXIF says, converted to sRGB where the file has a colour profile.
 * Throws an Error of one line.
 */
export async function decodePicture(file: Blob, name: string): Promise<Picture> {
  if (file.size === 0) throw new Error(`${name} is empty.`);
  let bitmap: ImageBitmap;
  try {
    // The orientation of EXIF is followed where nothing is said; some browsers know no word for it.
    bitmap = await createImageBitmap(file, { premultiplyAlpha: "none", colorSpaceConversion: "default" });
  } catch {
    const known = /^image\/(png|jpeg|webp|avif|gif|bmp)$/.test(file.type);
    throw new Error(
      known ? `${name} is damaged: the browser cannot read it.` : `${name} is not an image that a page can mesh; PNG, JPEG, WebP and AVIF are.`,
    );
  }
  const { width, height } = bitmap;
  if (width * height > kLargestPixels) {
    bitmap.close();
    const millions = Math.round((width * height) / 1e6);
    throw new Error(
      `${name} has ${width} × ${height} pixels, ${millions} million. A page has memory for ${kLargestPixels / 1e6} million; imgmesh-build takes any size.`,
    );
  }
  try {
    return { name, pixels: await readPixels(bitmap), bitmap, original: true };
  } catch (error) {
    bitmap.close();
    if (error instanceof RangeError)
      throw new Error(`${name} has ${width} × ${height} pixels, for which there is not enough memory.`);
    throw error;
  }
}
