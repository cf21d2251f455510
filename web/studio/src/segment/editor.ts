// Regions of the page: the cut, what the user made, marks of the cut-out, and the way back.
import { Regions, type SeedLine } from "imgmesh.wasm";
import type { SegmentStart } from "../worker/segment";
import { meanColors, packed, steadyColors } from "./colors";
import type { Mark } from "./overlay";
import type { RegionLook } from "./paint";

export type Display = "outlines" | "colors" | "flat" | "contours";

/** What is dropped of a cut-out, and what is selected or being touched. */
const kDropped = packed(16, 16, 20, 200), kSelected = packed(255, 255, 255, 90);

export class RegionEditor {
  readonly regions: Regions;
  marks: readonly Mark[] = [];
  /** A cell of the region that is selected, which stays selected as regions grow and shrink. */
  private selectedCell: number | null = null;
  touched: ReadonlySet<number> = new Set();
  /** Whether each pixel is kept; null while nothing is marked. */
  inside: Uint8Array | null = null;
  private insideCells: Uint8Array | null = null;
  /** What each step was, and where the user is in them. */
  private log: ("regions" | readonly Mark[])[] = [];
  private at = 0;
  private marksBefore: (readonly Mark[])[] = [];

  constructor(start: SegmentStart) {
    this.regions = new Regions(start.data, start.merges);
  }

  get canUndo(): boolean {
    return this.at > 0;
  }
  get canRedo(): boolean {
    return this.at < this.log.length;
  }

  get selected(): number | null {
    return this.selectedCell === null ? null : this.regions.table[this.selectedCell]!;
  }
  select(region: number | null): void {
    this.selectedCell = region === null ? null : this.regions.table.indexOf(region);
  }

  cut(merges: number, done: boolean): void {
    this.change(() => this.regions.cut(merges, done));
  }
  join(regions: Iterable<number>): number {
    return this.change(() => this.regions.join(regions));
  }
  split(region: number): boolean {
    return this.change(() => this.regions.split(region));
  }
  /** Takes back all that was joined, split and marked. */
  reset(): void {
    this.change(() => this.regions.reset());
    if (this.marks.length > 0) this.mark([]);
  }
  mark(marks: readonly Mark[]): void {
    this.marksBefore[this.at] = this.marks;
    this.push(marks);
    this.marks = marks;
  }

  /** Takes the last mark back for good. False if the last step was none. */
  dropLastMark(): boolean {
    if (this.at === 0 || this.log[this.at - 1] === "regions") return false;
    this.undo();
    this.log = this.log.slice(0, this.at);
    return true;
  }

  undo(): boolean {
    if (!this.canUndo) return false;
    const step = this.log[--this.at];
    if (step === "regions") this.regions.undo();
    else this.marks = this.marksBefore[this.at] ?? [];
    return true;
  }
  redo(): boolean {
    if (!this.canRedo) return false;
    const step = this.log[this.at++]!;
    if (step === "regions") this.regions.redo();
    else this.marks = step;
    return true;
  }

  lines(keep: boolean): SeedLine[] {
    return this.marks.filter((mark) => mark.keep === keep).map((mark) => mark.line);
  }

  setInside(inside: Uint8Array | null): void {
    this.inside = inside;
    this.insideCells = null;
    if (!inside) return;
    const { cells, count } = this.regions.data;
    this.insideCells = new Uint8Array(count);
    for (let i = 0; i < cells.length; ++i) if (inside[i]) this.insideCells[cells[i]!] = 1;
  }

  look(display: Display): RegionLook {
    const { regions, insideCells, selected, touched } = this, { table, count } = regions;
    const colors = display === "colors" ? steadyColors(regions, 170) : display === "flat" ? meanColors(regions) : new Uint32Array(count);
    const marked = new Uint8Array(count);
    if (selected !== null && selected < count) marked[selected] = 1;
    for (const region of touched) marked[region] = 1;
    if (display === "outlines" || display === "contours") for (let r = 0; r < count; ++r) if (marked[r]) colors[r] = kSelected;
    const fill = new Uint32Array(table.length);
    for (let cell = 0; cell < table.length; ++cell) fill[cell] = insideCells && !insideCells[cell] ? kDropped : colors[table[cell]!]!;
    return { table, fill, marked };
  }

  private change<T>(work: () => T): T {
    const before = this.regions.version;
    const result = work();
    if (this.regions.version !== before) this.push("regions");
    return result;
  }
  private push(step: "regions" | readonly Mark[]): void {
    this.log = [...this.log.slice(0, this.at), step];
    this.at = this.log.length;
  }
}
