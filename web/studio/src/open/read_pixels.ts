// The pixels of a decoded image as they are in the file: a 2D canvas stores colours multiplied by alpha, which
// loses them where alpha is small.
import type { Pixels } from "../contracts";

/** Rows are read in bands of about this many pixels, so that no second copy of a large image is needed. */
const kBand = 1 << 21;
/** Tiles that every WebGL takes. */
const kTile = 2048;

/** Returns the pixels of a bitmap that createImageBitmap() made with premultiplyAlpha "none". */
export async function readPixels(bitmap: ImageBitmap): Promise<Pixels> {
  const { width, height } = bitmap;
  const data = new Uint8ClampedArray(4 * width * height);
  if (!(await readOpaque(bitmap, data))) await readTransparent(bitmap, data);
  return { width, height, data };
}

/** Fills `data`, and returns true if every pixel is opaque: only then the colours are those of the image. */
async function readOpaque(bitmap: ImageBitmap, data: Uint8ClampedArray): Promise<boolean> {
  const { width, height } = bitmap;
  const rows = Math.max(1, Math.min(height, Math.floor(kBand / width)));
  const context = new OffscreenCanvas(width, rows).getContext("2d", { willReadFrequently: true });
  if (!context) throw new Error("This browser cannot read the image's pixels.");
  for (let y = 0; y < height; y += rows) {
    const count = Math.min(rows, height - y);
    context.clearRect(0, 0, width, rows);
    context.drawImage(bitmap, 0, y, width, count, 0, 0, width, count);
    const band = context.getImageData(0, 0, width, count).data;
    for (let i = 3; i < band.length; i += 4) if (band[i] !== 255) return false;
    data.set(band, 4 * width * y);
    // The page goes on between bands.
    if (y + rows < height) await new Promise((next) => setTimeout(next, 0));
  }
  return true;
}

/** Fills `data` by WebGL, which hands textures back as they were given. */
async function readTransparent(bitmap: ImageBitmap, data: Uint8ClampedArray): Promise<void> {
  const { width, height } = bitmap;
  const gl = new OffscreenCanvas(1, 1).getContext("webgl");
  if (!gl) throw new Error("This browser has no WebGL, without which colours under transparency cannot be read.");
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
  gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, false);
  for (let y = 0; y < height; y += kTile)
    for (let x = 0; x < width; x += kTile) {
      const w = Math.min(kTile, width - x), h = Math.min(kTile, height - y);
      const whole = w === width && h === height;
      const tile = whole ? bitmap : await createImageBitmap(bitmap, x, y, w, h, { premultiplyAlpha: "none" });
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, tile);
      gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, gl.getParameter(gl.TEXTURE_BINDING_2D), 0);
      const part = new Uint8Array(4 * w * h);
      gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, part);
      if (gl.getError() !== gl.NO_ERROR) throw new Error("The image's pixels could not be read by WebGL.");
      for (let row = 0; row < h; ++row)
        data.set(part.subarray(4 * w * row, 4 * w * (row + 1)), 4 * (width * (y + row) + x));
      if (!whole) tile.close();
    }
  gl.getExtension("WEBGL_lose_context")?.loseContext();
}
