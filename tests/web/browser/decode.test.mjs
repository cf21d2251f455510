// Decoding in Chromium: what the engine gets must be what is in the file.
import assert from "node:assert/strict";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { openStudio, png, root, startBrowser } from "./studio.mjs";

const { build } = await import(join(root, "web/node_modules/esbuild/lib/main.js"));

let host, page;
before(async () => {
  host = await startBrowser();
  ({ page } = await openStudio(host, { wait: false }));
  const { outputFiles } = await build({
    entryPoints: [join(root, "web/studio/src/open/decode.ts")], bundle: true, format: "esm", write: false,
  });
  await page.route("**/decode.js", (route) => route.fulfill({ contentType: "text/javascript", body: outputFiles[0].text }));
});
after(() => host.close());

/** What decodePicture() makes of a file: its sides and all values, or the message of its error. */
async function decode(bytes, type = "image/png") {
  const text = await page.evaluate(async ({ file, type }) => {
    const { decodePicture } = await import(new URL("decode.js", location.href).href);
    const bytes = Uint8Array.from(atob(file), (c) => c.charCodeAt(0));
    try {
      const { pixels } = await decodePicture(new Blob([bytes], { type }), "file");
      return { width: pixels.width, height: pixels.height, data: [...pixels.data] };
    } catch (error) {
      return { error: error.message };
    }
  }, { file: Buffer.from(bytes).toString("base64"), type });
  return text;
}

test("colours under every alpha are those of the file", async () => {
  const color = (x, y) => [(7 * x + 3) % 256, (11 * y + x) % 256, (5 * x + 13 * y) % 256, x];
  const { width, height, data } = await decode(png(256, 20, color));
  assert.deepEqual([width, height], [256, 20]);
  const expected = [];
  for (let y = 0; y < height; ++y) for (let x = 0; x < width; ++x) expected.push(...color(x, y));
  assert.deepEqual(data, expected);
});

test("an image of several tiles is put together", async () => {
  const color = (x, y) => [x % 256, x >> 8, y, (x + y) % 255];
  const { width, data } = await decode(png(2500, 3, color));
  for (const x of [0, 1, 2047, 2048, 2049, 2499])
    for (const y of [0, 2]) assert.deepEqual(data.slice(4 * (y * width + x), 4 * (y * width + x) + 4), color(x, y));
});

test("opaque colours are those of the file", async () => {
  const { data } = await decode(png(16, 16, (x, y) => [16 * x, 16 * y, 77, 255]));
  for (let i = 0; i < 256; ++i) assert.deepEqual(data.slice(4 * i, 4 * i + 4), [16 * (i % 16), 16 * (i >> 4), 77, 255]);
});

test("a photograph is turned as its EXIF says", async () => {
  // 32x16, left half white; orientation 6 says that the left side is to be shown at the top.
  const plain = await page.evaluate(async () => {
    const canvas = new OffscreenCanvas(32, 16), context = canvas.getContext("2d");
    context.fillRect(0, 0, 32, 16);
    context.fillStyle = "#fff";
    context.fillRect(0, 0, 16, 16);
    const blob = await canvas.convertToBlob({ type: "image/jpeg", quality: 1 });
    return [...new Uint8Array(await blob.arrayBuffer())];
  });
  const exif = Buffer.concat([
    Buffer.from([0xff, 0xe1, 0, 34]), Buffer.from("Exif\0\0MM\0*\0\0\0\x08", "latin1"),
    Buffer.from([0, 1, 0x01, 0x12, 0, 3, 0, 0, 0, 1, 0, 6, 0, 0, 0, 0, 0, 0]),
  ]);
  const turned = Buffer.concat([Buffer.from(plain.slice(0, 2)), exif, Buffer.from(plain.slice(2))]);
  const { width, height, data } = await decode(turned, "image/jpeg");
  assert.deepEqual([width, height], [16, 32]);
  assert.ok(data[4 * (4 * 16 + 8)] > 200 && data[4 * (27 * 16 + 8)] < 50);
});

test("an image that is too large is refused in one line", async () => {
  // Pixels of one colour are a small file.
  const { error } = await decode(png(8000, 6000));
  assert.match(error, /^file has 8000 × 6000 pixels, 48 million\..*imgmesh-build takes any size\.$/);
});
