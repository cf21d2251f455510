// The worker's part of building: pixels in, a mesh out.
import type { BuildOptions, BuildParameters, MeshFacts, Pixels } from "imgmesh.wasm";
import type { MethodTable, WorkerState } from "../contracts";

declare module "../contracts" {
  interface Methods {
    /** Meshes pixels, which the worker keeps. */
    "build.start": {
      args: { pixels: Pixels; parameters: BuildParameters; options: Omit<BuildOptions, "onProgress"> };
      result: MeshFacts;
    };
    /** Figures of a container that was opened are those against these pixels from now on. */
    "build.compareWith": { args: { pixels: Pixels }; result: void };
  }
}

export function methods(state: WorkerState): MethodTable<"build"> {
  return {
    "build.start"({ pixels, parameters, options }, report) {
      let last = 0;
      const mesh = state.imgmesh.build(pixels, parameters, {
        ...options,
        onProgress(fraction, stage) {
          // A build tells more often than anyone can see.
          const now = performance.now();
          if (now - last < 30) return;
          last = now;
          report(fraction, stage);
        },
      });
      state.mesh?.free();
      state.pixels = pixels;
      state.mesh = mesh;
      return mesh.facts();
    },
    "build.compareWith"({ pixels }) {
      state.pixels = pixels;
    },
  };
}
