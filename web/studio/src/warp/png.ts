// PNG files without loss: a canvas would round colours where they are partly transparent.
import type { Pixels } from "imgmesh.wasm";

function crc32(bytes: Uint8Array): number {
  let crc = ~0;
  for (const byte of bytes) {
    crc ^= byte;
    for (let k = 0; k < 8; ++k) crc = (crc >>> 1) ^ (0xedb88320 & -(crc & 1));
  }
  return ~crc >>> 0;
}

function chunk(type: string, data: Uint8Array): Uint8Array {
  const out = new Uint8Array(data.length + 12), view = new DataView(out.buffer);
  view.setUint32(0, data.length);
  out.set(new TextEncoder().encode(type), 4);
  out.set(data, 8);
  view.setUint32(data.length + 8, crc32(out.subarray(4, data.length + 8)));
  return out;
}

/** Differences of each sample from a guess by its left, upper and upper left neighbours: Paeth's filter. */
function filtered(samples: Uint8Array, row: number, height: number, step: number): Uint8Array {
  const kPaeth = 4, out = new Uint8Array(height * (row + 1));
  for (let y = 0; y < height; ++y) {
    out[y * (row + 1)] = kPaeth;
    for (let x = 0; x < row; ++x) {
      const i = y * row + x;
      const a = x < step ? 0 : samples[i - step]!, b = y === 0 ? 0 : samples[i - row]!;
      const c = x < step || y === 0 ? 0 : samples[i - row - step]!;
      const pa = Math.abs(b - c), pb = Math.abs(a - c), pc = Math.abs(a + b - 2 * c);
      out[y * (row + 1) + 1 + x] = samples[i]! - (pa <= pb && pa <= pc ? a : pb <= pc ? b : c);
    }
  }
  return out;
}

export async function encodePng({ width, height, data }: Pixels): Promise<Uint8Array> {
  const pixels = width * height;
  let opaque = true;
  for (let i = 3; i < 4 * pixels && opaque; i += 4) opaque = data[i] === 255;
  const step = opaque ? 3 : 4, samples = new Uint8Array(step * pixels);
  for (let i = 0; i < pixels; ++i) for (let c = 0; c < step; ++c) samples[step * i + c] = data[4 * i + c]!;
  const header = new Uint8Array(13), view = new DataView(header.buffer);
  view.setUint32(0, width);
  view.setUint32(4, height);
  header.set([8, opaque ? 2 : 6], 8);
  const rows = filtered(samples, step * width, height, step);
  const packed = new Blob([rows as BlobPart]).stream().pipeThrough(new CompressionStream("deflate"));
  const parts = [
    new Uint8Array([0x89, 0x50, 0x4e, 0x47, 13, 10, 26, 10]), chunk("IHDR", header),
    chunk("IDAT", new Uint8Array(await new Response(packed).arrayBuffer())), chunk("IEND", new Uint8Array()),
  ];
  return new Uint8Array(await new Blob(parts as BlobPart[]).arrayBuffer());
}
