// The decoder of coded pictures in Node: what imgmesh-encode writes is drawn byte for byte as imgmesh-decode draws it.
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { decode, info } from "../../../web/decoder/imgm.js";
import { temporaryFolder, tool } from "../support/native.mjs";
import { pixelsOf } from "../support/pictures.mjs";
import { decodePng, encodePng } from "../support/png.mjs";

const folder = temporaryFolder();
let files = 0;

/** The coded picture of pixels, at no more than so many bytes. */
function encode(pixels, bytes) {
  const picture = path.join(folder, `${++files}.png`), coded = path.join(folder, `${files}.imgm`);
  fs.writeFileSync(picture, encodePng(pixels));
  tool("imgmesh-encode", picture, "-o", coded, "--bytes", String(bytes), "--effort", "1", "--quiet");
  return coded;
}

/** Checks that both decoders draw the same at the picture's own size and at others. */
function checkSame(coded, channels) {
  const bytes = fs.readFileSync(coded), { width, height } = info(bytes);
  for (const size of [{ width, height }, { width: 37, height: 23 }, { width: 2 * width, height: 3 * height }]) {
    const picture = path.join(folder, "drawn.png");
    tool("imgmesh-decode", coded, "-o", picture, "--size", `${size.width}x${size.height}`, "--quiet");
    const drawn = decode(bytes, size), native = decodePng(fs.readFileSync(picture));
    assert.deepEqual([drawn.width, drawn.height, drawn.channels], [size.width, size.height, channels]);
    assert.ok(Buffer.from(drawn.data).equals(Buffer.from(native.data)), `${coded} at ${size.width} x ${size.height}`);
  }
}

const wave = (x, y) => [128 + 100 * Math.sin(x / 9 + y / 20), (5 * y) % 256, 128 + 90 * Math.cos(x / 5)].map(Math.round);

test("pictures of every kind are drawn as the native decoder draws them", () => {
  checkSame(encode(pixelsOf(120, 80, wave), 1500), 3);
  const grey = (x, y) => Array(3).fill(wave(x, y)[0]);
  checkSame(encode(pixelsOf(120, 80, grey), 700), 1);
  const disc = (x, y) => [...wave(x, y), Math.hypot(x - 40, y - 30) < 25 ? 255 : Math.min(255, 2 * x)];
  checkSame(encode(pixelsOf(90, 61, disc), 900), 4);
  checkSame(encode(pixelsOf(90, 61, (x, y) => [...grey(x, y), 255 - 2 * x]), 600), 2);
});

test("pictures of few pixels are drawn as the native decoder draws them", () => {
  for (const [width, height] of [[1, 1], [1, 40], [40, 1], [2, 2], [3, 2]]) checkSame(encode(pixelsOf(width, height, wave), 400), 3);
});

test("a photograph is drawn as the native decoder draws it", () => {
  const picture = new URL("../../data/kodim23.png", import.meta.url).pathname, coded = path.join(folder, "photograph.imgm");
  tool("imgmesh-encode", picture, "-o", coded, "--bytes", "4000", "--effort", "1", "--quiet");
  checkSame(coded, 3);
});

// More than 1024 pixels apart, tests of circles do not fit doubles.
test("pictures of long sides are drawn as the native decoder draws them", () => {
  checkSame(encode(pixelsOf(3000, 50, (x, y) => wave(x / 16, y)), 2000), 3);
});

// The example of docs/codec-format.md.
test("the example of the format's description is drawn as the native decoder draws it", () => {
  const page = fs.readFileSync(new URL("../../../docs/codec-format.md", import.meta.url), "utf8"), coded = path.join(folder, "example.imgm");
  fs.writeFileSync(coded, Buffer.from(/^ +(9a49[0-9a-f ]+)$/m.exec(page)[1].replaceAll(" ", ""), "hex"));
  checkSame(coded, 3);
  assert.deepEqual([...decode(fs.readFileSync(coded)).data.subarray(0, 8)], [23, 62, 167, 255, 26, 62, 162, 255]);
});

test("sizes follow from one side or a scale", () => {
  const bytes = fs.readFileSync(encode(pixelsOf(60, 40, wave), 300));
  const size = (options) => [decode(bytes, options).width, decode(bytes, options).height];
  assert.deepEqual(size(), [60, 40]);
  assert.deepEqual(size({ width: 30 }), [30, 20]);
  assert.deepEqual(size({ height: 80 }), [120, 80]);
  assert.deepEqual(size({ scale: 0.01 }), [1, 1]);
  for (const options of [{ scale: 1e4 }, { width: 70000 }, { scale: NaN }]) assert.throws(() => decode(bytes, options), /too large/);
});

test("bytes that are no coded picture throw an error that says so", () => {
  const bytes = fs.readFileSync(encode(pixelsOf(60, 40, wave), 300));
  const changed = (at, value) => Uint8Array.from(bytes, (byte, i) => (i === at ? value : byte));
  for (const call of [info, decode]) {
    assert.throws(() => call(new Uint8Array()), /is none/);
    assert.throws(() => call(changed(1, 0)), /is none/);
    assert.throws(() => call(changed(3, 0x22)), /unknown version/);
    assert.throws(() => call(changed(3, 0x16)), /unknown version/);
    assert.throws(() => call(bytes.subarray(0, 5)), /damaged/);
    assert.throws(() => call(Uint8Array.of(...bytes.subarray(0, 4), 0xff, 0xff, 3, 0xff, 0xff, 3)), /too large/);
  }
  for (const cut of [10, 40, 200]) assert.throws(() => decode(bytes.subarray(0, bytes.length - cut)), /damaged/);
  assert.throws(() => decode(Uint8Array.of(...bytes, ...bytes)), /damaged/);
});

// Damaged files are drawn or refused: neither decoder fails in another way, and both do the same.
test("changed and shortened files are taken by both decoders or by neither", () => {
  const bytes = fs.readFileSync(encode(pixelsOf(60, 40, wave), 300)), coded = path.join(folder, "changed.imgm");
  const damaged = [];
  for (let at = 4; at < bytes.length; at += 14)
    damaged.push(Uint8Array.from(bytes, (byte, i) => (i === at ? byte ^ 0x55 : byte)), bytes.subarray(0, at));
  for (const file of damaged) {
    fs.writeFileSync(coded, file);
    let native = true, drawn;
    try {
      tool("imgmesh-decode", coded, "-o", path.join(folder, "changed.png"), "--quiet");
    } catch {
      native = false;
    }
    try {
      drawn = decode(file);
    } catch (error) {
      assert.match(error.message, /^The coded picture (is|has) /);
    }
    assert.equal(drawn !== undefined, native);
    if (native) assert.ok(Buffer.from(drawn.data).equals(Buffer.from(decodePng(fs.readFileSync(path.join(folder, "changed.png"))).data)));
  }
});
