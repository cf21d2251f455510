// The worker's part of showing a mesh: its arrays, drawings and figures.
import type { Comparison, DrawMode, Pixels, Quality } from "imgmesh.wasm";
import type { MethodTable, WorkerState } from "../contracts";

/** What is needed to draw a level at any zoom. */
export interface MeshArrays {
  positions: Float32Array;
  faces: Uint32Array;
  edges: Uint32Array;
  /** L*, u*, v* and perhaps alpha of every vertex. */
  features: Float32Array;
}

export interface Figures {
  /** Errors of the reconstruction; absent where the pixels of the image are not known. */
  comparison?: Comparison;
  quality: Quality;
}

declare module "../contracts" {
  interface Methods {
    "view.arrays": { args: { level: number }; result: MeshArrays };
    "view.draw": { args: { mode: DrawMode; level: number }; result: Pixels };
    "view.figures": { args: { level: number }; result: Figures };
  }
}

export function methods(state: WorkerState): MethodTable<"view"> {
  const mesh = () => {
    if (!state.mesh) throw new Error("there is no mesh yet");
    return state.mesh;
  };
  return {
    "view.arrays": ({ level }) => ({
      positions: mesh().positions(level),
      faces: mesh().faces(level),
      edges: mesh().edges(level),
      features: mesh().features(level),
    }),
    "view.draw": ({ mode, level }) => mesh().draw(mode, level),
    "view.figures": ({ level }) => ({
      ...(state.pixels ? { comparison: mesh().compare(state.pixels, level) } : {}),
      quality: mesh().quality(level),
    }),
  };
}
