// meshoptimizer (npm, WebAssembly) on the pixel grid with L*u*v* as attributes.
//
//     node meshoptimizer.mjs FEATURES VERTICES METHOD OUT
//
// METHOD: attributes (vertices stay where they are), update (positions and colours are those of the quadrics),
// halving (update, quadrics taken anew at every halving). Prints the processor time of the call as JSON.
import { MeshoptSimplifier } from "meshoptimizer";
import { gridIndices, gridPositions, readFeatures, writeMesh } from "./grid.mjs";

const [features, vertices, method, out] = process.argv.slice(2);
const grid = readFeatures(features);
const indices = gridIndices(grid), positions = gridPositions(grid), luv = grid.luv;
// The mesh is flat: geometry has an error at the border alone, where the library weighs it; L* counts from 0 to 1.
const weights = [0.01, 0.01, 0.01];
const noError = 1e9; // the count alone ends it
// Two triangles a vertex, as Euler has it but for the border.
const target = 3 * 2 * Number(vertices);

await MeshoptSimplifier.ready;
MeshoptSimplifier.useExperimentalFeatures = true;
const before = process.cpuUsage();
let result = indices;
if (method === "attributes") {
  result = MeshoptSimplifier.simplifyWithAttributes(indices, positions, 3, luv, 3, weights, null, target, noError)[0];
} else if (method === "update") {
  result = indices.subarray(0, MeshoptSimplifier.simplifyWithUpdate(indices, positions, 3, luv, 3, weights, null, target, noError)[0]);
} else if (method === "halving") {
  // Each round starts on the vertices that are left, as fewer as there are.
  let mesh = indices, p = positions, a = luv;
  while (mesh.length > target) {
    const next = Math.max(target, 3 * Math.ceil(mesh.length / 6));
    const count = MeshoptSimplifier.simplifyWithUpdate(mesh, p, 3, a, 3, weights, null, next, noError)[0];
    if (count >= mesh.length) break;
    mesh = mesh.slice(0, count);
    const [remap, unique] = MeshoptSimplifier.compactMesh(mesh);
    const q = new Float32Array(3 * unique), b = new Float32Array(3 * unique);
    remap.forEach((to, from) => {
      if (to === 0xffffffff) return;
      q.set(p.subarray(3 * from, 3 * from + 3), 3 * to);
      b.set(a.subarray(3 * from, 3 * from + 3), 3 * to);
    });
    p = q;
    a = b;
  }
  positions.set(p);
  luv.set(a);
  result = mesh;
} else {
  throw new Error(`method ${method}: expected attributes, update or halving`);
}
const used = process.cpuUsage(before);
writeMesh(out, result, positions, luv);
console.log(JSON.stringify({ user_seconds: used.user / 1e6, system_seconds: used.system / 1e6 }));
