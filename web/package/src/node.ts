// The package in Node, where the engine is a file.
import { readFile } from "node:fs/promises";
import { startDraco, type DracoSource } from "./draco.js";
import type { EngineSource } from "./engine.js";
import { startImgmesh, type Imgmesh } from "./imgmesh.js";

export * from "./exports.js";

/** Loads the engine from beside this file, or from its bytes or a compiled module. */
export async function loadImgmesh(engine?: EngineSource): Promise<Imgmesh> {
  return startImgmesh(engine ?? (await readFile(new URL("engine.wasm", import.meta.url))));
}

/** Loads Draco, from beside this file unless it is said. Containers with it can be opened and saved from then on. */
export async function loadDraco(source: DracoSource = {}): Promise<void> {
  return startDraco({
    encoder: source.encoder ?? (await readFile(new URL("draco_encoder.wasm", import.meta.url))),
    decoder: source.decoder ?? (await readFile(new URL("draco_decoder.wasm", import.meta.url))),
  });
}
