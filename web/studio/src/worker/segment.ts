// The worker's part of segmenting: cells and merges once, then drawings of any regions made of them.
import type { ContourMap, Pixels, SeedLine, Segmentation, SegmentationData, SegmentOptions } from "imgmesh.wasm";
import type { MethodTable, WorkerState } from "../contracts";

export interface SegmentStart {
  data: SegmentationData;
  /** How many merges the default threshold does. */
  merges: number;
  /** Why there are not as many superpixels as wanted, or nothing. */
  missed: string;
}

declare module "../contracts" {
  interface Methods {
    /** Computes a segmentation, which the worker keeps for the methods below. */
    "segment.start": { args: { options: Omit<SegmentOptions, "onProgress"> }; result: SegmentStart };
    /** `table` is the region of every cell. */
    "segment.draw": { args: { what: "outlines" | "flat" | "colors"; table: Uint32Array }; result: Pixels };
    "segment.svg": { args: { table: Uint32Array }; result: string };
    "segment.contours": { args: object; result: ContourMap };
    "segment.mask": { args: { table: Uint32Array; keep: SeedLine[]; drop: SeedLine[] }; result: Uint8Array };
  }
  interface WorkerState {
    segmentation?: Segmentation;
  }
}

export function methods(state: WorkerState): MethodTable<"segment"> {
  const segmentation = () => {
    if (!state.segmentation) throw new Error("there are no regions yet");
    return state.segmentation;
  };
  return {
    "segment.start"({ options }, report) {
      if (!state.mesh) throw new Error("there is no mesh yet");
      const next = state.imgmesh.segment(state.mesh, state.pixels, { ...options, onProgress: report });
      state.segmentation?.free();
      state.segmentation = next;
      const { merges, missed } = next.facts();
      return { data: next.data(), merges, missed };
    },
    "segment.draw": ({ what, table }) => segmentation().draw(what, table),
    "segment.svg": ({ table }) => segmentation().svg(table),
    "segment.contours": () => segmentation().contours(),
    "segment.mask": ({ table, keep, drop }) => segmentation().mask(table, keep, drop),
  };
}
