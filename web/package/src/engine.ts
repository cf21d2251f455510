// The functions that the WebAssembly module exports (web/engine/bind_*.cpp), and how it starts. Each theme adds
// its own functions to the interface Engine by declaration merging.
import { libraries, type Libraries } from "./libraries.js";
import type { BuildOptions, BuildParameters, Comparison, DrawMode, MeshFacts, Parameter, Pixels, Quality } from "./types.js";

export interface Engine {
  version: string;
  build(
    pixels: Pixels,
    parameters: BuildParameters,
    options: BuildOptions,
    progress: ((fraction: number, stage: string) => void) | null,
  ): EngineMesh;
  buildParameters(): Parameter[];
  /** Its memory, to see how much it takes. */
  HEAPU8: Uint8Array;
}

/** An object of C++: it lives until delete() is called. */
export interface EngineObject {
  delete(): void;
}

export interface EngineMesh extends EngineObject {
  facts(): MeshFacts;
  positions(level: number): Float32Array;
  faces(level: number): Uint32Array;
  edges(level: number): Uint32Array;
  features(level: number): Float32Array;
  faceIds(level: number): Uint32Array;
  barycentrics(level: number): Float32Array;
  draw(mode: DrawMode, level: number, scale: number): Pixels;
  svg(mode: string, level: number): string;
  quality(level: number): Quality;
  compare(pixels: Pixels, level: number): Comparison;
}

/** The engine as it is found: a place to fetch it from, its bytes, or a module that was compiled before. */
export type EngineSource = string | URL | BufferSource | WebAssembly.Module;

interface Loader {
  libraries: Libraries;
  wasmBinary?: BufferSource;
  instantiateWasm?: (
    imports: WebAssembly.Imports,
    ready: (instance: WebAssembly.Instance, module: WebAssembly.Module) => void,
  ) => object;
}
type CreateEngine = (loader: Loader) => Promise<Engine>;

async function compile(source: EngineSource): Promise<WebAssembly.Module> {
  if (source instanceof WebAssembly.Module) return source;
  if (typeof source !== "string" && !(source instanceof URL)) return WebAssembly.compile(source);
  const response = await fetch(source);
  if (!response.ok) throw new Error(`${source}: the server answers ${response.status}, expected the engine`);
  // Streaming wants the type application/wasm, which not every server gives.
  if (response.headers.get("content-type")?.startsWith("application/wasm"))
    return WebAssembly.compileStreaming(response);
  return WebAssembly.compile(await response.arrayBuffer());
}

/** Starts the engine. Every call makes an instance with memory of its own. */
export async function startEngine(source: EngineSource): Promise<Engine> {
  const module = await compile(source);
  const create = (await import("./engine.mjs")).default as CreateEngine;
  return new Promise((resolve, reject) => {
    create({
      libraries,
      instantiateWasm(imports, ready) {
        WebAssembly.instantiate(module, imports).then((instance) => ready(instance, module), reject);
        return {};
      },
    }).then(resolve, reject);
  });
}
