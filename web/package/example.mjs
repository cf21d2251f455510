// Meshes a picture that is computed here, and prints what came of it: node example.mjs
import { loadImgmesh } from "imgmesh.wasm";

const width = 320, height = 200, data = new Uint8ClampedArray(4 * width * height);
for (let i = 0; i < width * height; ++i) {
  const x = i % width, y = Math.floor(i / width), inside = Math.hypot(x - 160, y - 100) < 70;
  data.set([inside ? 230 : x / 2, inside ? 120 : y, inside ? 40 : 160, 255], 4 * i);
}
const imgmesh = await loadImgmesh();
const mesh = imgmesh.build({ width, height, data }, { vertices: 400 });
const { vertices, faces, rms } = mesh.facts().levels[0];
console.log(`${vertices} vertices, ${faces} triangles, RMS error ${rms.toFixed(2)} in L*u*v*`);
console.log(`PSNR ${mesh.compare({ width, height, data }).psnr.toFixed(1)} dB, ${mesh.quality().flippedFaces} folds`);
mesh.free();
