// Regions made of cells: any cut of the hierarchy, and what a user joins and splits on top of it. Plain arrays
// alone, so that a page can keep one beside its image and answer at once, whatever the worker is doing.

/** What Regions are made from; Segmentation.data() gives it. Typed arrays may be moved to another thread. */
export interface SegmentationData {
  width: number;
  height: number;
  /** The cell of every pixel, numbered by their first pixels; 4294967295 outside the mask. */
  cells: Uint32Array;
  /** Of cells. */
  count: number;
  /** Two cells for every merge: the regions that they begin become one. The first is the lower. */
  merges: Uint32Array;
  /** The threshold above which each merge is done; never falls. */
  heights: Float32Array;
  /** So many merges are done at any threshold, because of a least size. */
  forced: number;
  /** Four values for every border: cell a, cell b, its length in pixels, and how many merges make the two one. */
  borders: Uint32Array;
  /** Four values for every cell: its pixels, and the sums of their L*, u* and v*. */
  sums: Float64Array;
}

/** A step that undo() goes back to. */
interface Step {
  merges: number;
  /** Of every cell: 0, or the number of the region that the user made of it. null: none is made. */
  own: Uint32Array | null;
}

const kNoCell = 0xffffffff;

/** Sets of cells that become one. A set is known by its lowest cell. */
class Sets {
  private readonly parent: Uint32Array;

  constructor(count: number) {
    this.parent = Uint32Array.from({ length: count }, (_, cell) => cell);
  }
  find(cell: number): number {
    const parent = this.parent;
    while (parent[cell] !== cell) cell = parent[cell] = parent[parent[cell]!]!;
    return cell;
  }
  join(a: number, b: number): boolean {
    const p = this.find(a), q = this.find(b);
    this.parent[Math.max(p, q)] = Math.min(p, q);
    return p !== q;
  }
}

/**
 * The regions of one segmentation. They are connected, and numbered from 0 by their first pixels, row by row, as
 * those of imgmesh-segment are. Regions that the user joined or split keep their outlines when the cut moves.
 */
export class Regions {
  readonly data: SegmentationData;
  /** The region of every cell. It is another array after every change. */
  table = new Uint32Array(0);
  /** Of regions. */
  count = 0;
  private step: Step;
  /** Steps, and where in them the user is. The current cut may be on its way to a step that is not there yet. */
  private steps: Step[];
  private at = 0;
  /** Grows with every step that is new. */
  version = 0;

  constructor(data: SegmentationData, merges = 0) {
    this.data = data;
    this.step = { merges, own: null };
    this.steps = [this.step];
    this.update();
  }

  get merges(): number {
    return this.step.merges;
  }
  get canUndo(): boolean {
    return this.at > 0;
  }
  get canRedo(): boolean {
    return this.at + 1 < this.steps.length;
  }
  /** Whether the user joined or split any. */
  get edited(): boolean {
    return this.step.own !== null;
  }

  /** How many merges are done at a threshold: those below it. */
  mergesBelow(threshold: number): number {
    const { heights } = this.data;
    let low = 0, high = heights.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (heights[middle]! < threshold) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  /**
   * How many merges leave this number of regions, or nearly so where there is none. With regions of the user's own it
   * takes up to so many `tries`, each a few milliseconds at a megapixel; one is near enough under a slider.
   */
  mergesFor(count: number, tries = 8): number {
    const { count: cells, forced, heights } = this.data;
    const possible = (merges: number): number => Math.min(Math.max(merges, forced), heights.length);
    let merges = possible(cells - Math.round(count));
    if (!this.edited) return merges;
    // A merge makes at most one region fewer, and none inside what the user made.
    for (; tries > 0; --tries) {
      const next = possible(merges + this.tableOf(merges).count - Math.round(count));
      if (next === merges) break;
      merges = next;
    }
    return merges;
  }

  /** The height of the last merge that is done. */
  get height(): number {
    return this.step.merges > 0 ? this.data.heights[this.step.merges - 1]! : 0;
  }

  /** Does so many merges. `done` makes it a step; without it the cut is on its way, as under a slider. */
  cut(merges: number, done = true): void {
    merges = Math.min(Math.max(Math.round(merges), 0), this.data.heights.length);
    if (merges !== this.step.merges) {
      this.step = { ...this.step, merges };
      this.update();
    }
    if (done && this.steps[this.at]!.merges !== merges) this.remember();
  }

  /** The region at a pixel, or null beyond the image and its mask. */
  regionAt(x: number, y: number): number | null {
    const { width, height, cells } = this.data;
    if (!(x >= 0 && y >= 0 && x < width && y < height)) return null;
    const cell = cells[Math.floor(y) * width + Math.floor(x)]!;
    return cell === kNoCell ? null : this.table[cell]!;
  }

  /** Of every region its pixels and the means of L*, u* and v*: four values. */
  means(): Float64Array {
    const means = new Float64Array(4 * this.count), { sums } = this.data;
    for (let cell = 0; cell < this.table.length; ++cell)
      for (let k = 0; k < 4; ++k) means[4 * this.table[cell]! + k]! += sums[4 * cell + k]!;
    for (let region = 0; region < this.count; ++region)
      for (let k = 1; k < 4; ++k) means[4 * region + k]! /= means[4 * region]!;
    return means;
  }

  /** The neighbour that a region merges with first, or null for a region without neighbours. */
  mostAlike(region: number): number | null {
    const { borders } = this.data;
    let best: number | null = null, least = Infinity, longest = 0;
    for (let e = 0; e < borders.length; e += 4) {
      const a = this.table[borders[e]!]!, b = this.table[borders[e + 1]!]!;
      if ((a === region) === (b === region)) continue;
      const length = borders[e + 2]!, merge = borders[e + 3]!;
      if (merge > least || (merge === least && length <= longest)) continue;
      best = a === region ? b : a;
      least = merge;
      longest = length;
    }
    return best;
  }

  /**
   * Makes one region of those that touch, and of each further group of them that touch. Returns how many
   * regions fewer there are.
   */
  join(regions: Iterable<number>): number {
    const chosen = new Set(regions), { borders } = this.data, sets = new Sets(this.count);
    let fewer = 0;
    for (let e = 0; e < borders.length; e += 4) {
      const a = this.table[borders[e]!]!, b = this.table[borders[e + 1]!]!;
      if (a !== b && chosen.has(a) && chosen.has(b) && sets.join(a, b)) ++fewer;
    }
    if (fewer === 0) return 0;
    const sizes = new Uint32Array(this.count);
    for (const region of chosen) ++sizes[sets.find(region)]!;
    this.own((region) => (chosen.has(region) && sizes[sets.find(region)]! > 1 ? sets.find(region) : null));
    return fewer;
  }

  /** Splits a region where it would be split next as the threshold falls. False: it is one cell only. */
  split(region: number): boolean {
    const { borders } = this.data, inside: number[] = [];
    for (let e = 0; e < borders.length; e += 4)
      if (this.table[borders[e]!] === region && this.table[borders[e + 1]!] === region) inside.push(e);
    if (inside.length === 0) return false;
    inside.sort((e, f) => borders[e + 3]! - borders[f + 3]! || e - f);
    // The border whose merge makes the region whole is the one to cut.
    let left = -1;
    for (const cell of this.table) left += Number(cell === region);
    const sets = new Sets(this.table.length);
    for (const e of inside) {
      if (sets.find(borders[e]!) === sets.find(borders[e + 1]!)) continue;
      if (--left === 0) break;
      sets.join(borders[e]!, borders[e + 1]!);
    }
    const first = sets.find(this.table.indexOf(region));
    this.own((of, cell) => (of !== region ? null : sets.find(cell) === first ? 0 : 1));
    return true;
  }

  /** Forgets all that the user joined and split. */
  reset(): void {
    if (!this.edited) return;
    this.step = { ...this.step, own: null };
    this.update();
    this.remember();
  }
  undo(): boolean {
    return this.go(this.at - 1);
  }
  redo(): boolean {
    return this.go(this.at + 1);
  }

  /** The region of every pixel, row by row; 4294967295 outside the mask. */
  labels(): Uint32Array {
    return this.data.cells.map((cell) => (cell === kNoCell ? kNoCell : this.table[cell]!));
  }

  private go(to: number): boolean {
    const step = this.steps[to];
    if (!step) return false;
    this.at = to;
    this.step = step;
    this.update();
    return true;
  }

  private remember(): void {
    this.steps = [...this.steps.slice(0, this.at + 1), this.step];
    this.at = this.steps.length - 1;
    ++this.version;
  }

  /** Makes cells the user's own: those for which `group` gives the same number are one region. */
  private own(group: (region: number, cell: number) => number | null): void {
    const own = this.step.own ? this.step.own.slice() : new Uint32Array(this.data.count);
    const numbers = new Map<number, number>();
    let next = own.reduce((most, number) => Math.max(most, number), 0) + 1;
    for (let cell = 0; cell < own.length; ++cell) {
      const of = group(this.table[cell]!, cell);
      if (of === null) continue;
      if (!numbers.has(of)) numbers.set(of, next++);
      own[cell] = numbers.get(of)!;
    }
    this.step = { ...this.step, own };
    this.update();
    this.remember();
  }

  private update(): void {
    Object.assign(this, this.tableOf(this.step.merges));
  }

  /** The region of every cell after so many merges, beside what the user made. */
  private tableOf(done: number): { table: Uint32Array; count: number } {
    const { count: cells, merges, borders } = this.data, { own } = this.step;
    // As regions_after() in C++: the cells of a merge begin their regions, and the first is the lower.
    let root = new Uint32Array(cells);
    for (let cell = 0; cell < cells; ++cell) root[cell] = cell;
    for (let k = 0; k < done; ++k) root[merges[2 * k + 1]!] = merges[2 * k]!;
    for (let cell = 0; cell < cells; ++cell) root[cell] = root[root[cell]!]!;
    if (own) {
      // What the user made may cut what is left of a region into parts.
      const sets = new Sets(cells), whole = root;
      for (let e = 0; e < borders.length; e += 4) {
        const a = borders[e]!, b = borders[e + 1]!;
        if (own[a] === own[b] && (own[a] !== 0 || whole[a] === whole[b])) sets.join(a, b);
      }
      root = root.map((_, cell) => sets.find(cell));
    }
    let count = 0;
    const table = new Uint32Array(cells);
    for (let cell = 0; cell < cells; ++cell) table[cell] = root[cell] === cell ? count++ : table[root[cell]!]!;
    return { table, count };
  }
}
