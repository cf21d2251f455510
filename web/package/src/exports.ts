// What the package gives, wherever it runs.
export { Imgmesh } from "./imgmesh.js";
export { Mesh } from "./mesh.js";
export type { EngineSource } from "./engine.js";
export * from "./types.js";
