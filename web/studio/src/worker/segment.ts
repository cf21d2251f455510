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

export interface Marked {
  table: Uint32Array;
  keep: SeedLine[];
  drop: SeedLine[];
}

declare module "../contracts" {
  interface Methods {
    /** Computes a segmentation, which the worker keeps for the methods below. */
    "segment.start": { args: { options: Omit<SegmentOptions, "onProgress"> }; result: SegmentStart };
    /** `table` is the region of every cell. */
    "segment.drawing": { args: { what: "outlines" | "flat" | "colors"; table: Uint32Array }; result: Uint8Array };
    /** By the extension of `name`; labels are of pixels. */
    "segment.labels": { args: { name: string; labels: Uint32Array }; result: Uint8Array };
    "segment.svg": { args: { table: Uint32Array }; result: string };
    "segment.pieces": { args: { table: Uint32Array }; result: Uint8Array };
    "segment.contours": { args: object; result: ContourMap };
    "segment.contourFile": { args: { name: string }; result: Uint8Array };
    "segment.mask": { args: Marked; result: Uint8Array };
    "segment.maskPng": { args: Marked; result: Uint8Array };
    /** The image where `inside` is not 0. */
    "segment.cutOut": { args: { pixels: Pixels; inside: Uint8Array }; result: Uint8Array };
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
    "segment.drawing": ({ what, table }) => state.imgmesh.encodePng(segmentation().draw(what, table)),
    "segment.labels"({ name, labels }) {
      const { width, height } = segmentation().facts();
      return state.imgmesh.exportLabels(name, width, height, labels);
    },
    "segment.svg": ({ table }) => segmentation().svg(table),
    "segment.pieces": ({ table }) => segmentation().pieces(table),
    "segment.contours": () => segmentation().contours(),
    "segment.contourFile": ({ name }) => segmentation().contourFile(name),
    "segment.mask": ({ table, keep, drop }) => segmentation().mask(table, keep, drop),
    "segment.maskPng": ({ table, keep, drop }) => segmentation().maskPng(table, keep, drop),
    "segment.cutOut"({ pixels: { width, height, data: source }, inside }) {
      const data = new Uint8ClampedArray(source);
      inside.forEach((kept, i) => kept || data.fill(0, 4 * i, 4 * i + 4));
      return state.imgmesh.encodePng({ width, height, data });
    },
  };
}
