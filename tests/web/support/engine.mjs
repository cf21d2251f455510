// Starts the engine in Node. IMGMESH_ENGINE is the folder of engine.mjs and engine.wasm, build/web/bin unless it is set.
import fs from "node:fs";
import path from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

export async function startEngine() {
  const folder = process.env.IMGMESH_ENGINE ?? fileURLToPath(new URL("../../../build/web/bin", import.meta.url));
  const { default: create } = await import(pathToFileURL(path.join(folder, "engine.mjs")));
  return create({ wasmBinary: fs.readFileSync(path.join(folder, "engine.wasm")) });
}
