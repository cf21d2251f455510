// Reads and writes PNG files of 8 bits a sample, as far as the tests need them.
import zlib from "node:zlib";

const kChannels = { 0: 1, 2: 3, 4: 2, 6: 4 };

function chunk(type, data) {
  const head = Buffer.alloc(8);
  head.writeUInt32BE(data.length, 0);
  head.write(type, 4, "latin1");
  const check = Buffer.alloc(4);
  check.writeUInt32BE(crc32(Buffer.concat([head.subarray(4), data])), 0);
  return Buffer.concat([head, data, check]);
}

function crc32(bytes) {
  let crc = 0xffffffff;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; ++bit) crc = crc & 1 ? (crc >>> 1) ^ 0xedb88320 : crc >>> 1;
  }
  return (crc ^ 0xffffffff) >>> 0;
}

/** Returns a PNG of pixels { width, height, data } with 4 samples each; without alpha where all are opaque. */
export function encodePng({ width, height, data }) {
  const opaque = data.every((sample, i) => i % 4 !== 3 || sample === 255);
  const samples = opaque ? data.filter((_, i) => i % 4 !== 3) : data;
  const row = (opaque ? 3 : 4) * width;
  const header = Buffer.alloc(13);
  header.writeUInt32BE(width, 0);
  header.writeUInt32BE(height, 4);
  header.set([8, opaque ? 2 : 6, 0, 0, 0], 8);
  const rows = Buffer.alloc(height * (row + 1));
  for (let y = 0; y < height; ++y) rows.set(samples.subarray(row * y, row * (y + 1)), y * (row + 1) + 1);
  return Buffer.concat([
    Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]),
    chunk("IHDR", header),
    chunk("IDAT", zlib.deflateSync(rows)),
    chunk("IEND", Buffer.alloc(0)),
  ]);
}

function unfilter(filter, row, above, step) {
  for (let i = 0; i < row.length; ++i) {
    const a = i < step ? 0 : row[i - step],
      b = above ? above[i] : 0,
      c = i < step || !above ? 0 : above[i - step];
    const p = a + b - c;
    const [pa, pb, pc] = [Math.abs(p - a), Math.abs(p - b), Math.abs(p - c)];
    const paeth = pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
    row[i] += [0, a, b, (a + b) >> 1, paeth][filter];
  }
}

/** Returns the pixels of a PNG with 4 samples each. Throws for palettes, 16 bits and interlacing. */
export function decodePng(bytes) {
  const file = Buffer.from(bytes);
  let width = 0, height = 0, type = 0;
  const packed = [];
  for (let at = 8; at < file.length; ) {
    const length = file.readUInt32BE(at),
      name = file.toString("latin1", at + 4, at + 8);
    const data = file.subarray(at + 8, at + 8 + length);
    if (name === "IHDR") {
      [width, height, type] = [data.readUInt32BE(0), data.readUInt32BE(4), data[9]];
      if (data[8] !== 8 || data[12] !== 0 || !(type in kChannels)) throw new Error(`PNG of another kind: ${data[8]} bits, type ${type}`);
    }
    if (name === "IDAT") packed.push(data);
    at += 12 + length;
  }
  const channels = kChannels[type];
  const rows = zlib.inflateSync(Buffer.concat(packed));
  const pixels = new Uint8Array(4 * width * height).fill(255);
  let above = null;
  for (let y = 0; y < height; ++y) {
    const start = y * (channels * width + 1);
    const row = rows.subarray(start + 1, start + 1 + channels * width);
    unfilter(rows[start], row, above, channels);
    for (let x = 0; x < width; ++x)
      for (let c = 0; c < 4; ++c) {
        const grey = channels < 3;
        const alpha = channels % 2 === 0 ? row[channels * (x + 1) - 1] : 255;
        pixels[4 * (y * width + x) + c] = c === 3 ? alpha : row[channels * x + (grey ? 0 : c)];
      }
    above = row;
  }
  return { width, height, data: pixels };
}
