// The package in Node, where the engine is a file.
import { readFile } from "node:fs/promises";
import type { EngineSource } from "./engine.js";
import { startImgmesh, type Imgmesh } from "./imgmesh.js";

export * from "./exports.js";

/** Loads the engine from beside this file, or from its bytes or a compiled module. */
export async function loadImgmesh(engine?: EngineSource): Promise<Imgmesh> {
  return startImgmesh(engine ?? (await readFile(new URL("engine.wasm", import.meta.url))));
}
