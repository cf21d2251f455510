// Starts the engine in Node. IMGMESH_ENGINE is the folder of engine.mjs and engine.wasm.
import fs from "node:fs";
import path from "node:path";
import { pathToFileURL } from "node:url";

export async function startEngine() {
  const folder = process.env.IMGMESH_ENGINE;
  if (!folder) throw new Error("IMGMESH_ENGINE is not set: expected the folder of engine.mjs");
  const { default: create } = await import(pathToFileURL(path.join(folder, "engine.mjs")));
  return create({ wasmBinary: fs.readFileSync(path.join(folder, "engine.wasm")) });
}
