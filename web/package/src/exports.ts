// What the package gives, wherever it runs.
export { Imgmesh } from "./imgmesh.js";
export { Mesh } from "./mesh.js";
export { Regions, type SegmentationData } from "./regions.js";
export {
  Segmentation,
  type ContourMap,
  type RegionFacts,
  type SeedLine,
  type SegmentFacts,
  type SegmentOptions,
} from "./segment.js";
export {
  WarpSession, type FloatMap, type VertexSelection, type WarpEdit, type WarpEdits, type WarpHandle, type WarpSolver,
} from "./warp.js";
export { needsDraco, savesWithDraco, type NamedFile, type SaveOptions } from "./container.js";
export type { DracoSource } from "./draco.js";
export type { TextFormat } from "./export.js";
export type { EngineSource } from "./engine.js";
export * from "./types.js";
