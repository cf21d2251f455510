// The package in browsers and workers.
import { startDraco, type DracoSource } from "./draco.js";
import type { EngineSource } from "./engine.js";
import { startImgmesh, type Imgmesh } from "./imgmesh.js";

export * from "./exports.js";

/**
 * Loads the engine. Without an argument it is fetched from beside this file; a page that compiles it once hands
 * the module to all of its workers.
 */
export function loadImgmesh(engine: EngineSource = new URL("engine.wasm", import.meta.url)): Promise<Imgmesh> {
  return startImgmesh(engine);
}

/** Loads Draco, from beside this file unless it is said. Containers with it can be opened and saved from then on. */
export function loadDraco(source: DracoSource = {}): Promise<void> {
  const { encoder, decoder } = source;
  return startDraco({
    encoder: encoder ?? new URL("draco_encoder.wasm", import.meta.url),
    decoder: decoder ?? new URL("draco_decoder.wasm", import.meta.url),
  });
}
