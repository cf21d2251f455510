// The worker's part of warping.
import { loadDraco, savesWithDraco, WarpSession, type Mesh, type NamedFile, type Pixels, type WarpEdits } from "imgmesh.wasm";
import type { MethodTable, WorkerState } from "../contracts";
import { sampledMaps, type SampledMaps } from "./warp_samples";

/** More folded cells than these are counted, but not shown. */
const kMostPlaces = 20000;

/** What edits do to the vertices. */
export interface Solved {
  /** x and y of the moves of every level's vertices; empty where none moves. */
  moves: Float32Array[];
  /** Of the level that is shown: where its vertices are, and the faces that are turned over. */
  places: Float32Array;
  turned: Uint32Array;
  /** A line for each level where a handle could not get where it should. */
  missed: string[];
  /** How long the solver took, in ms. */
  time: number;
}

/** What takes longer, for all levels. */
export interface Folds {
  /** The number of faces of every level that are turned over. */
  turned: number[];
  /** How many cells of pixels are turned over, and where some of them are in the warped image, x and y. */
  cells: number;
  places: Float32Array;
}

declare module "../contracts" {
  interface Methods {
    "warp.solve": { args: { edits: WarpEdits; level: number; drag: boolean }; result: Solved };
    "warp.folds": { args: null; result: Folds };
    "warp.maps": { args: { most: number }; result: SampledMaps };
    /** The warped pixels; with at most `most` of them, if that is given. */
    "warp.picture": { args: { most?: number }; result: Pixels };
    "warp.png": { args: null; result: Uint8Array };
    /** Throws where a face would turn over. */
    "warp.container": { args: { name: string }; result: NamedFile[] };
    "warp.exr": { args: { map: "stmap" | "displacement" }; result: Uint8Array };
  }
  interface WorkerState {
    warp?: { mesh: Mesh; edits: WarpSession };
    reconstruction?: Pixels;
  }
}

export function methods(state: WorkerState): MethodTable<"warp"> {
  const session = (): WarpSession => {
    if (!state.mesh) throw new Error("there is no mesh yet");
    if (state.warp?.mesh !== state.mesh) {
      state.warp?.edits.free();
      state.warp = { mesh: state.mesh, edits: new WarpSession(state.imgmesh, state.mesh) };
    }
    return state.warp.edits;
  };
  // A container that was opened alone has only its reconstruction.
  const pixels = (): Pixels => state.pixels ?? (state.reconstruction ??= state.mesh!.draw());
  return {
    "warp.solve": ({ edits, level, drag }) => {
      const warp = session(), start = performance.now(), missed = warp.solve(edits, drag);
      return {
        time: performance.now() - start,
        moves: state.mesh!.facts().levels.map((_, k) => warp.moves(k)),
        places: warp.places(level),
        turned: warp.turnedFaces(level),
        missed,
      };
    },
    "warp.folds": () => {
      const cells = session().foldedPixels(), { width, levels } = state.mesh!.facts();
      const shown = cells.subarray(0, kMostPlaces), places = new Float32Array(2 * shown.length);
      const move = shown.length > 0 ? session().displacement().data : places;
      shown.forEach((pixel, i) => {
        places[2 * i] = (pixel % width) + 0.5 + move[2 * pixel]!;
        places[2 * i + 1] = Math.floor(pixel / width) + 0.5 + move[2 * pixel + 1]!;
      });
      return { turned: levels.map((_, k) => session().turnedFaces(k).length), cells: cells.length, places };
    },
    "warp.maps": ({ most }) => sampledMaps(state.mesh!, most),
    "warp.picture": ({ most = Infinity }) => {
      const { width, height } = pixels(), share = Math.min(1, Math.sqrt(most / (width * height)));
      const scaled = (side: number): number => Math.max(1, Math.round(share * side));
      return session().picture(pixels(), share < 1 ? { width: scaled(width), height: scaled(height) } : undefined);
    },
    "warp.png": () => state.imgmesh.encodePng(session().picture(pixels())),
    "warp.exr": ({ map }) => (map === "stmap" ? session().stMapExr(state.pixels) : session().displacementExr()),
    async "warp.container"({ name }) {
      const warped = session().warpedMesh();
      try {
        if (savesWithDraco({ name })) await loadDraco();
        return warped.save({ name });
      } finally {
        warped.free();
      }
    },
  };
}
