// The engine with a friendly surface.
import { startEngine, type Engine, type EngineSource } from "./engine.js";
import type { NamedFile } from "./container.js";
import { Mesh } from "./mesh.js";
import { segmentMesh, type Segmentation, type SegmentOptions } from "./segment.js";
import type { BuildOptions, BuildParameters, Parameter, Pixels } from "./types.js";

/** One instance of the engine. It has memory of its own, which never shrinks while the instance lives. */
export class Imgmesh {
  /** For the other classes of this package. */
  readonly engine: Engine;

  constructor(engine: Engine) {
    this.engine = engine;
  }

  get version(): string {
    return this.engine.version;
  }

  /** Bytes of memory that the instance has taken. */
  get memory(): number {
    return this.engine.HEAPU8.byteLength;
  }

  /** All parameters that build() takes. */
  parameters(): Parameter[] {
    return this.engine.buildParameters();
  }

  /**
   * Meshes pixels, as imgmesh-build does: the same mesh and the same pixel map, to the bit. Blocks until it is
   * done; terminate the worker to stop it. Throws ImgmeshError.
   */
  build(pixels: Pixels, parameters: BuildParameters = {}, options: BuildOptions = {}): Mesh {
    return new Mesh(this.engine.build(pixels, parameters, options, options.onProgress ?? null));
  }

  /**
   * Cuts a level of a mesh into cells and merges them, as imgmesh-segment does: the same regions to the bit. Colours
   * are measured on `pixels`, of the mesh's size, or on the reconstruction without them. Throws ImgmeshError.
   */
  segment(mesh: Mesh, pixels: Pixels | null = null, options: SegmentOptions = {}): Segmentation {
    return segmentMesh(this.engine, mesh, pixels, options);
  }

  /**
   * Opens a container: a .glb, or a .gltf and the files that it names, in any order. Where needsDraco() says so,
   * loadDraco() must have finished before. Throws ImgmeshError, of one line, for whatever is wrong with the files.
   */
  open(files: NamedFile[]): Mesh {
    return new Mesh(this.engine.open(files));
  }

  /** Pixels as a PNG of 8 bits. */
  encodePng(pixels: Pixels): Uint8Array {
    return this.engine.encodePng(pixels);
  }

  /**
   * One label for each pixel, 4294967295 for none, as the file `name`: .png (16 bits, labels up to 65534), .tif,
   * .npy, .mat or .exr, as imgmesh-segment writes them.
   */
  exportLabels(name: string, width: number, height: number, labels: Uint32Array): Uint8Array {
    return this.engine.exportLabels(name, width, height, labels);
  }
}

/** Starts an instance from `source`: where engine.wasm is, its bytes, or a compiled module. */
export async function startImgmesh(source: EngineSource): Promise<Imgmesh> {
  return new Imgmesh(await startEngine(source));
}
