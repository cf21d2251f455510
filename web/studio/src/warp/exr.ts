// EXR files of floats, as compositors read maps: scanlines, ZIP.
import type { FloatMap } from "imgmesh.wasm";

const kRowsOfBlock = 16;

function text(value: string): number[] {
  return [...new TextEncoder().encode(value), 0];
}
function numbers(kind: "int" | "float", ...values: number[]): number[] {
  const view = new DataView(new ArrayBuffer(4 * values.length));
  values.forEach((value, i) => (kind === "int" ? view.setInt32(4 * i, value, true) : view.setFloat32(4 * i, value, true)));
  return [...new Uint8Array(view.buffer)];
}
function attribute(name: string, type: string, value: number[]): number[] {
  return [...text(name), ...text(type), ...numbers("int", value.length), ...value];
}

function header({ width, height }: FloatMap, channels: string[]): number[] {
  const kFloat = 2, kZip = 3, box = numbers("int", 0, 0, width - 1, height - 1);
  const list = channels.flatMap((name) => [...text(name), ...numbers("int", kFloat, 0, 1, 1)]);
  return [
    ...numbers("int", 0x01312f76, 2),
    ...attribute("channels", "chlist", [...list, 0]),
    ...attribute("compression", "compression", [kZip]),
    ...attribute("dataWindow", "box2i", box),
    ...attribute("displayWindow", "box2i", box),
    ...attribute("lineOrder", "lineOrder", [0]),
    ...attribute("pixelAspectRatio", "float", numbers("float", 1)),
    ...attribute("screenWindowCenter", "v2f", numbers("float", 0, 0)),
    ...attribute("screenWindowWidth", "float", numbers("float", 1)),
    0,
  ];
}

async function deflated(bytes: Uint8Array): Promise<Uint8Array> {
  const stream = new Blob([bytes as BlobPart]).stream().pipeThrough(new CompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** OpenEXR's ZIP: bytes of even and odd places apart, differences of neighbours, deflate; as it is if that is no shorter. */
async function zipped(raw: Uint8Array): Promise<Uint8Array> {
  const apart = new Uint8Array(raw.length), half = (raw.length + 1) >> 1;
  for (let i = 0; i < raw.length; ++i) apart[(i & 1 ? half : 0) + (i >> 1)] = raw[i]!;
  for (let i = raw.length - 1; i > 0; --i) apart[i] = apart[i]! - apart[i - 1]! + 128;
  const packed = await deflated(apart);
  return packed.length < raw.length ? packed : raw;
}

/** Returns the file. Channels keep their names; values are as they are. */
export async function floatExr(map: FloatMap): Promise<Uint8Array> {
  const { width, height, data } = map, count = map.channels.length;
  const order = map.channels.map((name, at) => ({ name, at })).sort((a, b) => (a.name < b.name ? -1 : 1));
  const head = header(map, order.map(({ name }) => name));
  const blocks: Uint8Array[] = [];
  for (let top = 0; top < height; top += kRowsOfBlock) {
    const rows = Math.min(kRowsOfBlock, height - top), raw = new DataView(new ArrayBuffer(4 * rows * width * count));
    let at = 0;
    for (let y = top; y < top + rows; ++y)
      for (const channel of order)
        for (let x = 0; x < width; ++x, at += 4) raw.setFloat32(at, data[count * (y * width + x) + channel.at]!, true);
    const packed = await zipped(new Uint8Array(raw.buffer));
    const block = new Uint8Array(8 + packed.length);
    block.set(numbers("int", top, packed.length));
    block.set(packed, 8);
    blocks.push(block);
  }
  const begin = head.length + 8 * blocks.length;
  const file = new Uint8Array(blocks.reduce((sum, block) => sum + block.length, begin));
  file.set(head);
  const offsets = new DataView(file.buffer, head.length);
  let at = begin;
  blocks.forEach((block, i) => {
    offsets.setBigUint64(8 * i, BigInt(at), true);
    file.set(block, at);
    at += block.length;
  });
  return file;
}
