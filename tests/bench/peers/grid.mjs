// The pixel grid that simplifiers get, and the file of what they give back (raw_files.h).
import fs from "node:fs";

// {width, height, luv}: three features a pixel.
export function readFeatures(path) {
  const bytes = fs.readFileSync(path);
  if (bytes.toString("latin1", 0, 8) !== "IMFEAT1\n") throw new Error(`${path}: no file of features`);
  const width = bytes.readUInt32LE(8), height = bytes.readUInt32LE(12);
  const luv = new Float32Array(bytes.buffer.slice(bytes.byteOffset + 16, bytes.byteOffset + 16 + 12 * width * height));
  return { width, height, luv };
}

// Two triangles a cell, split along the diagonal whose ends differ less, as imgmesh does it.
export function gridIndices({ width, height, luv }) {
  const distance = (a, b) => {
    let sum = 0;
    for (let c = 0; c < 3; ++c) sum += (luv[3 * a + c] - luv[3 * b + c]) ** 2;
    return sum;
  };
  const indices = new Uint32Array(6 * (width - 1) * (height - 1));
  let at = 0;
  for (let y = 0; y + 1 < height; ++y)
    for (let x = 0; x + 1 < width; ++x) {
      const a = y * width + x, b = a + 1, c = a + width, d = c + 1;
      indices.set(distance(a, d) <= distance(b, c) ? [a, c, d, a, d, b] : [a, c, b, b, c, d], at);
      at += 6;
    }
  return indices;
}

export function gridPositions({ width, height }) {
  const positions = new Float32Array(3 * width * height);
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) {
      positions[3 * (y * width + x)] = x;
      positions[3 * (y * width + x) + 1] = y;
    }
  return positions;
}

// Vertices in use, renumbered in the order of their first use.
export function writeMesh(path, indices, positions, luv) {
  const number = new Map();
  const faces = new Uint32Array(indices.length);
  indices.forEach((v, i) => {
    if (!number.has(v)) number.set(v, number.size);
    faces[i] = number.get(v);
  });
  const header = Buffer.alloc(16);
  header.write("IMMESH1\n", "latin1");
  header.writeUInt32LE(number.size, 8);
  header.writeUInt32LE(faces.length / 3, 12);
  const vertices = new Float32Array(5 * number.size);
  for (const [v, i] of number)
    vertices.set([positions[3 * v], positions[3 * v + 1], luv[3 * v], luv[3 * v + 1], luv[3 * v + 2]], 5 * i);
  fs.writeFileSync(path, Buffer.concat([header, Buffer.from(vertices.buffer), Buffer.from(faces.buffer)]));
}
