// The edits that a hand makes: values that are never changed, so that undo only goes back to older ones.
import type { WarpEdit, WarpEdits, WarpSolver } from "imgmesh.wasm";

/** How far a handle may go along x and y, in pixels, and how far it may turn, in degrees (schemas/imgmesh-warp.edits.schema.json). */
export const kMostMove = 1e6, kMostTurn = 1e6;
/** How small and large a scaling may be. */
export const kLeastScale = 0.001, kMostScale = 1000;

/** One edit of one level. */
export interface HandEdit {
  readonly id: number;
  readonly level: number;
  readonly solver: WarpSolver;
  /** Of the vertices that the hand holds: right and down, in pixels. */
  readonly moves: ReadonlyMap<number, readonly [number, number]>;
  /** Vertices that stay. */
  readonly pins: ReadonlySet<number>;
  /** Whether the mesh's border stays, too. */
  readonly border: boolean;
}

/** All that undo takes back. */
export interface EditState {
  readonly edits: readonly HandEdit[];
  /** The edit that the next handle belongs to. */
  readonly current: number | null;
}

let nextId = 1;

export function newEdit(level: number, solver: WarpSolver, border: boolean): HandEdit {
  return { id: nextId++, level, solver, moves: new Map(), pins: new Set(), border };
}

export function withEdit(state: EditState, edit: HandEdit): EditState {
  const known = state.edits.some(({ id }) => id === edit.id);
  const edits = known ? state.edits.map((e) => (e.id === edit.id ? edit : e)) : [...state.edits, edit];
  return { edits, current: edit.id };
}

export function withoutEdit(state: EditState, id: number): EditState {
  const edits = state.edits.filter((e) => e.id !== id);
  return { edits, current: state.current === id ? null : state.current };
}

/**
 * The edits as imgmesh-warp reads them. With positions of every level's vertices they are named by their
 * places, which every container of the mesh shares; without, by their numbers in this mesh, which is quicker
 * to solve.
 */
export function asDocument(state: EditState, positions?: readonly (Float32Array | undefined)[]): WarpEdits {
  const edits: WarpEdit[] = [];
  for (const edit of state.edits) {
    if (edit.moves.size === 0) continue;
    const at = positions?.[edit.level];
    const named = (v: number) => (at ? { near: [at[2 * v]!, at[2 * v + 1]!] as [number, number] } : { vertex: v });
    const pins = [...edit.pins].filter((v) => !edit.moves.has(v));
    edits.push({
      level: edit.level,
      solver: edit.solver,
      handles: [...edit.moves].map(([v, [x, y]]) => ({ ...named(v), move: [x, y] })),
      ...(pins.length > 0 || edit.border
        ? { pins: [...pins.map(named), ...(edit.border ? [{ border: true as const }] : [])] }
        : {}),
    });
  }
  return { edits };
}

/** The states that undo and redo go to. */
export class History {
  private past: EditState[] = [];
  private future: EditState[] = [];
  state: EditState = { edits: [], current: null };

  get canUndo(): boolean {
    return this.past.length > 0;
  }
  get canRedo(): boolean {
    return this.future.length > 0;
  }
  /** Goes on to a state. During a drag, steps replace each other: pass the state before it as `from`. */
  set(state: EditState, from: EditState = this.state): void {
    if (state === from) return;
    this.past.push(from);
    this.future = [];
    this.state = state;
  }
  /** Shows a state that undo will not go back to. */
  preview(state: EditState): void {
    this.state = state;
  }
  undo(): boolean {
    const before = this.past.pop();
    if (!before) return false;
    this.future.push(this.state);
    this.state = before;
    return true;
  }
  redo(): boolean {
    const after = this.future.pop();
    if (!after) return false;
    this.past.push(this.state);
    this.state = after;
    return true;
  }
  /** All states that undo and redo may show. */
  get states(): readonly EditState[] {
    return [...this.past, this.state, ...this.future];
  }
  /** Puts another state in the place of each. */
  replace(other: (state: EditState) => EditState): void {
    this.past = this.past.map(other);
    this.future = this.future.map(other);
    this.state = other(this.state);
  }
  clear(): void {
    this.past = [];
    this.future = [];
    this.state = { edits: [], current: null };
  }
}
