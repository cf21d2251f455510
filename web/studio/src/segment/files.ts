// Files of labels and images that need no more than the browser: PNG and .npy.
import type { Pixels } from "imgmesh.wasm";

const kTable = Uint32Array.from({ length: 256 }, (_, n) => {
  for (let bit = 0; bit < 8; ++bit) n = n & 1 ? (n >>> 1) ^ 0xedb88320 : n >>> 1;
  return n >>> 0;
});

function crc(bytes: Uint8Array): number {
  let value = 0xffffffff;
  for (const byte of bytes) value = (value >>> 8) ^ kTable[(value ^ byte) & 255]!;
  return (value ^ 0xffffffff) >>> 0;
}

function chunk(type: string, data: Uint8Array): Uint8Array {
  const bytes = new Uint8Array(data.length + 12), view = new DataView(bytes.buffer);
  view.setUint32(0, data.length);
  for (let k = 0; k < 4; ++k) bytes[4 + k] = type.charCodeAt(k);
  bytes.set(data, 8);
  view.setUint32(data.length + 8, crc(bytes.subarray(4, data.length + 8)));
  return bytes;
}

async function deflated(bytes: Uint8Array): Promise<Uint8Array> {
  const stream = new Blob([bytes as BlobPart]).stream().pipeThrough(new CompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** A PNG of whole rows of samples. `type` is 0 for grey and 6 for R, G, B and A; samples of 16 bits are big-endian. */
async function png(width: number, height: number, bits: 8 | 16, type: 0 | 6, samples: Uint8Array): Promise<Uint8Array> {
  const stride = samples.length / height, rows = new Uint8Array(height * (stride + 1));
  for (let y = 0; y < height; ++y) {
    // Differences to the row above pack better; the first row has none.
    const filter = y > 0 ? 2 : 0, at = y * (stride + 1) + 1, from = y * stride;
    rows[at - 1] = filter;
    for (let k = 0; k < stride; ++k) rows[at + k] = samples[from + k]! - (filter ? samples[from + k - stride]! : 0);
  }
  const header = new Uint8Array(13), view = new DataView(header.buffer);
  view.setUint32(0, width);
  view.setUint32(4, height);
  header.set([bits, type, 0, 0, 0], 8);
  const parts = [
    Uint8Array.of(0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a),
    chunk("IHDR", header),
    ...(type === 6 ? [chunk("sRGB", Uint8Array.of(0))] : []),
    chunk("IDAT", await deflated(rows)),
    chunk("IEND", new Uint8Array(0)),
  ];
  return new Uint8Array(await new Blob(parts as BlobPart[]).arrayBuffer());
}

export function imagePng({ width, height, data }: Pixels): Promise<Uint8Array> {
  return png(width, height, 8, 6, new Uint8Array(data.buffer, data.byteOffset, data.byteLength));
}

/** White inside, black outside, as imgmesh-build --mask takes it. */
export function maskPng(width: number, height: number, inside: Uint8Array): Promise<Uint8Array> {
  return png(width, height, 8, 0, inside.map((v) => 255 * v));
}

/** Grey of 16 bits, 65535 outside the mask. */
export function labelsPng(width: number, height: number, labels: Uint32Array): Promise<Uint8Array> {
  const samples = new Uint8Array(2 * labels.length);
  labels.forEach((label, i) => {
    if (label > 65534 && label !== 0xffffffff) throw new Error("A PNG holds at most 65535 regions. Save labels as .npy, or choose fewer.");
    samples[2 * i] = (label >> 8) & 255;
    samples[2 * i + 1] = label & 255;
  });
  return png(width, height, 16, 0, samples);
}

/** An array of numpy, height x width; 4294967295 outside the mask. */
export function npy(width: number, height: number, values: Uint32Array | Float32Array): Uint8Array {
  const type = values instanceof Float32Array ? "<f4" : "<u4";
  const text = `{'descr': '${type}', 'fortran_order': False, 'shape': (${height}, ${width}), }`;
  const length = Math.ceil((10 + text.length + 1) / 64) * 64 - 10;
  const bytes = new Uint8Array(10 + length + values.byteLength);
  bytes.set([0x93, ...new TextEncoder().encode("NUMPY"), 1, 0, length & 255, length >> 8]);
  bytes.set(new TextEncoder().encode(text.padEnd(length - 1) + "\n"), 10);
  bytes.set(new Uint8Array(values.buffer, values.byteOffset, values.byteLength), 10 + length);
  return bytes;
}
