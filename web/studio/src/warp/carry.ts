// Edits of a mesh that is built again: each vertex is found again by its place, as imgmesh-warp finds `near`.
import type { EditState, HandEdit } from "./edits";

type Move = readonly [number, number];

/** The edit as the hand made it, on the mesh that it was made on. */
interface Made {
  edit: HandEdit;
  positions: Float32Array;
}

/** Of edits that were carried over and not changed since: a mesh that is coarser for a while loses nothing. */
const made = new WeakMap<HandEdit, Made>();

/** The level of the new mesh that an edit goes to. Of a level that there is no more, the coarsest. */
export function levelAfter(edit: HandEdit, levels: number): number {
  return Math.min((made.get(edit)?.edit ?? edit).level, levels - 1);
}

/** Takes states from one mesh to the next. Both lists are positions by level; `after` needs those that levelAfter() names. */
export class Carrier {
  private readonly before: readonly (Float32Array | undefined)[];
  private readonly after: readonly (Float32Array | undefined)[];
  private readonly levels: number;
  private readonly finders = new Map<Float32Array, NearestVertex>();
  private readonly edits = new Map<HandEdit, HandEdit>();

  constructor(before: readonly (Float32Array | undefined)[], after: readonly (Float32Array | undefined)[], levels: number) {
    this.before = before;
    this.after = after;
    this.levels = levels;
  }

  state({ edits, current }: EditState): EditState {
    return { edits: edits.map((edit) => this.edit(edit)), current };
  }

  private edit(now: HandEdit): HandEdit {
    const known = this.edits.get(now);
    if (known) return known;
    const from = made.get(now) ?? { edit: now, positions: this.before[now.level]! };
    const { edit, positions } = from, level = levelAfter(now, this.levels), to = this.after[level]!;
    let finder = this.finders.get(to);
    if (!finder) this.finders.set(to, (finder = new NearestVertex(to)));
    const find = (v: number): number => finder.at(positions[2 * v]!, positions[2 * v + 1]!);
    // Handles that come together on one vertex go their mean way.
    const sums = new Map<number, [number, number, number]>();
    for (const [v, [x, y]] of edit.moves) {
      const found = find(v), [sx, sy, count] = sums.get(found) ?? [0, 0, 0];
      sums.set(found, [sx + x, sy + y, count + 1]);
    }
    const moves = new Map([...sums].map(([v, [x, y, count]]): [number, Move] => [v, [x / count, y / count]]));
    const pins = new Set([...edit.pins].map(find).filter((v) => !moves.has(v)));
    const carried = { ...edit, level, moves, pins };
    made.set(carried, from);
    this.edits.set(now, carried);
    return carried;
  }
}

/** Finds the vertex nearest to a point; of equal ones, that with the lowest number. */
class NearestVertex {
  private readonly positions: Float32Array;
  /** Vertices from left to right. */
  private readonly order: Uint32Array;

  constructor(positions: Float32Array) {
    this.positions = positions;
    this.order = Uint32Array.from({ length: positions.length / 2 }, (_, v) => v).sort((a, b) => positions[2 * a]! - positions[2 * b]!);
  }

  at(x: number, y: number): number {
    const { positions, order } = this;
    let low = 0, high = order.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (positions[2 * order[middle]!]! < x) low = middle + 1;
      else high = middle;
    }
    let best = -1, least = Infinity;
    /** Returns whether vertices farther off on this side may be nearer. */
    const look = (k: number): boolean => {
      const v = order[k];
      if (v === undefined) return false;
      const dx = positions[2 * v]! - x, dy = positions[2 * v + 1]! - y, distance = dx * dx + dy * dy;
      if (distance < least || (distance === least && v < best)) [best, least] = [v, distance];
      return dx * dx <= least;
    };
    let left = low - 1, right = low;
    for (let toLeft = true, toRight = true; toLeft || toRight; ) {
      if (toLeft) toLeft = look(left--);
      if (toRight) toRight = look(right++);
    }
    return best;
  }
}
