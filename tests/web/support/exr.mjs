// Reads EXR files of several parts as imgmesh writes them: scanlines, ZIP, 32-bit floats.
import zlib from "node:zlib";

const kRowsOfBlock = 16, kFloat = 2, kZip = 3;

class Reader {
  constructor(bytes) {
    this.file = Buffer.from(bytes);
    this.at = 0;
  }
  int() {
    return this.file.readInt32LE((this.at += 4) - 4);
  }
  text() {
    const end = this.file.indexOf(0, this.at);
    const text = this.file.toString("latin1", this.at, end);
    this.at = end + 1;
    return text;
  }
}

function attribute(type, data) {
  if (type === "string") return data.toString("latin1");
  if (type === "box2i") return [0, 4, 8, 12].map((at) => data.readInt32LE(at));
  if (type === "int") return data.readInt32LE(0);
  if (type === "compression") return data[0];
  if (type !== "chlist") return null;
  const channels = [], reader = new Reader(data);
  while (data[reader.at] !== 0) {
    channels.push({ name: reader.text(), type: reader.int() });
    reader.at += 12;
  }
  return channels;
}

function unpack(data, size) {
  if (data.length === size) return data;
  const halves = zlib.inflateSync(data);
  for (let i = 1; i < size; ++i) halves[i] = (halves[i - 1] + halves[i] - 128) & 255;
  const whole = Buffer.alloc(size), half = (size + 1) >> 1;
  for (let i = 0; i < size; ++i) whole[i] = halves[(i & 1 ? half : 0) + (i >> 1)];
  return whole;
}

/** Returns a part { name, width, height, channels: { NAME: Float32Array } } for each part of the file. */
export function readExr(bytes) {
  const reader = new Reader(bytes);
  reader.int();
  const several = (reader.int() & 0x1000) !== 0;
  const parts = [];
  do {
    const header = {};
    for (let name = reader.text(); name; name = reader.text()) {
      const type = reader.text(), size = reader.int();
      header[name] = attribute(type, reader.file.subarray(reader.at, (reader.at += size)));
    }
    const [left, top, right, bottom] = header.dataWindow;
    if (header.compression !== kZip || header.channels.some((c) => c.type !== kFloat))
      throw new Error("EXR of another kind: expected ZIP and FLOAT");
    const part = { name: header.name ?? "", width: right - left + 1, height: bottom - top + 1, top, channels: {} };
    for (const c of header.channels) part.channels[c.name] = new Float32Array(part.width * part.height);
    parts.push(part);
  } while (several && reader.file[reader.at] !== 0);
  if (several) ++reader.at;
  const blocks = parts.map((p) => Math.ceil(p.height / kRowsOfBlock)).reduce((a, b) => a + b);
  reader.at += 8 * blocks;
  for (let block = 0; block < blocks; ++block) {
    const part = parts[several ? reader.int() : 0];
    const y = reader.int() - part.top, size = reader.int();
    const rows = Math.min(kRowsOfBlock, part.height - y), names = Object.keys(part.channels);
    const data = unpack(reader.file.subarray(reader.at, (reader.at += size)), 4 * rows * part.width * names.length);
    let at = 0;
    for (let row = y; row < y + rows; ++row)
      for (const name of names)
        for (let x = 0; x < part.width; ++x, at += 4) part.channels[name][row * part.width + x] = data.readFloatLE(at);
  }
  return parts;
}
