// The package in browsers and workers.
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
