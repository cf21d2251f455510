// The state of the panel and its overlay: edits, what is selected, and what the solver makes of it.
import type { WarpSolver } from "imgmesh.wasm";
import type { Picture, Session, Studio } from "../contracts";
import type { Folds } from "../worker/warp";
import { Carrier, levelAfter } from "./carry";
import { asDocument, History, kMostMove, newEdit, withEdit, withoutEdit, type EditState, type HandEdit } from "./edits";
import { LevelMesh } from "./level_mesh";

export type Tool = "move" | "select" | "pin";
export type Transformation = (x: number, y: number) => readonly [number, number];

/** How long the hand must rest before what takes longer is computed, in ms. */
const kPause = 150;

export class WarpEditor {
  readonly history = new History();
  readonly selection = new Set<number>();
  tool: Tool = "move";
  solver: WarpSolver = "arap";
  border = true;
  level = 0;
  mesh: LevelMesh | null = null;
  /** x and y of the level's vertices in the warped image. */
  places: Float32Array = new Float32Array();
  /** Of every level: moves of the vertices by its own edits; empty where none moves. */
  moves: readonly Float32Array[] = [];
  turned: Uint32Array = new Uint32Array();
  folds: Folds | null = null;
  missed: readonly string[] = [];
  dragging = false;
  /** How long the solver took for the last step, in ms. */
  stepTime = 0;
  /** Is called when anything above has changed. */
  changed: () => void = () => {};
  /** Is called when vertices have moved; `exact` if this is no step of a drag. */
  moved: (exact: boolean) => void = () => {};
  /** Is called when the hand rests. */
  rested: () => void = () => {};

  private forgetProblem: () => void = () => {};
  private readonly studio: Studio;
  private known: LevelMesh[] = [];
  private session: Session | null = null;
  private picture: Picture | null = null;
  private openings = 0;
  private wanted: { drag: boolean } | null = null;
  private running = false;
  private pause = 0;
  private base: { state: EditState; edit: HandEdit; places: Float32Array } | null = null;

  constructor(studio: Studio) {
    this.studio = studio;
  }

  get state(): EditState {
    return this.history.state;
  }
  get current(): HandEdit | null {
    return this.state.edits.find(({ id }) => id === this.state.current) ?? null;
  }
  /** Of the levels that were shown, and so may have edits. */
  get positions(): readonly (Float32Array | undefined)[] {
    return this.known.map((mesh) => mesh.arrays.positions);
  }

  /** Goes on with the session's mesh: edits of the same picture stay. Without a session they wait for one. */
  async open(session: Session | null): Promise<void> {
    const mine = ++this.openings, { facts, picture } = this.studio;
    if (this.base) this.endDrag();
    const same = picture !== null && picture === this.picture && this.known.length > 0;
    this.picture = picture;
    if (!same) {
      this.history.clear();
      this.known = [];
    }
    // Nothing is solved until the edits are those of the new mesh.
    this.session = null;
    window.clearTimeout(this.pause);
    this.selection.clear();
    this.mesh = null;
    this.places = new Float32Array();
    this.moves = [];
    this.turned = new Uint32Array();
    this.folds = null;
    this.missed = [];
    this.changed();
    if (!session || !facts) return;
    const levels = facts.levels.length, known: LevelMesh[] = [];
    if (same) {
      const missing = (): number | undefined =>
        this.history.states.flatMap(({ edits }) => edits.map((edit) => levelAfter(edit, levels))).find((level) => !known[level]);
      for (let level = missing(); level !== undefined; level = missing()) {
        known[level] = new LevelMesh(await session.ask("view.arrays", { level }));
        if (mine !== this.openings) return;
      }
      const carrier = new Carrier(this.positions, known.map((mesh) => mesh.arrays.positions), levels);
      this.history.replace((state) => carrier.state(state));
    } else {
      this.border = !facts.hasMask;
    }
    this.known = known;
    this.session = session;
    await this.chooseLevel(this.current?.level ?? Math.min(this.level, levels - 1));
  }

  async chooseLevel(level: number): Promise<void> {
    const { session } = this;
    if (!session) return;
    if (!this.known[level]) {
      const arrays = await session.ask("view.arrays", { level });
      if (session !== this.session) return;
      this.known[level] = new LevelMesh(arrays);
    }
    this.level = level;
    this.mesh = this.known[level]!;
    this.places = this.mesh.arrays.positions;
    this.turned = new Uint32Array();
    this.selection.clear();
    if (this.current && this.current.level !== level) this.history.preview({ ...this.state, current: null });
    this.request(false);
    this.changed();
  }

  setSolver(solver: WarpSolver): void {
    this.solver = solver;
    const edit = this.current;
    if (edit) this.change(withEdit(this.state, { ...edit, solver }));
    else this.changed();
  }

  setBorder(border: boolean): void {
    this.border = border;
    const edit = this.current;
    if (edit) this.change(withEdit(this.state, { ...edit, border }));
    else this.changed();
  }

  async chooseEdit(id: number): Promise<void> {
    const edit = this.state.edits.find((e) => e.id === id);
    if (!edit) return;
    if (edit.level !== this.level) await this.chooseLevel(edit.level);
    this.selection.clear();
    this.history.preview({ ...this.state, current: id });
    this.solver = edit.solver;
    this.border = edit.border;
    this.changed();
  }

  /** The next handle begins another edit, whose moves add to those before. */
  beginEdit(): void {
    this.selection.clear();
    this.history.preview({ ...this.state, current: null });
    this.changed();
  }

  deleteEdit(id: number): void {
    this.selection.clear();
    this.change(withoutEdit(this.state, id));
  }

  reset(): void {
    this.selection.clear();
    if (this.state.edits.length > 0) this.change({ edits: [], current: null });
  }

  undo(): void {
    this.endDrag();
    if (this.history.undo()) this.afterTravel();
  }
  redo(): void {
    this.endDrag();
    if (this.history.redo()) this.afterTravel();
  }
  private afterTravel(): void {
    const edit = this.current;
    if (edit) [this.solver, this.border] = [edit.solver, edit.border];
    if (edit && edit.level !== this.level) void this.chooseLevel(edit.level);
    for (const v of this.selection) if (!edit?.moves.has(v)) this.selection.delete(v);
    this.request(false);
    this.changed();
  }

  /** Removes the selected vertices from handles and pins of the edit. */
  deleteSelected(): void {
    const edit = this.current;
    if (!edit || this.selection.size === 0) return;
    const moves = new Map(edit.moves), pins = new Set(edit.pins);
    for (const v of this.selection) {
      moves.delete(v);
      pins.delete(v);
    }
    this.selection.clear();
    this.change(moves.size + pins.size === 0 ? withoutEdit(this.state, edit.id) : withEdit(this.state, { ...edit, moves, pins }));
  }

  /** Pins vertices, or frees them if all are pinned. */
  togglePins(vertices: Iterable<number>): void {
    const edit = this.editToChange(), all = [...vertices];
    if (all.length === 0) return;
    const pins = new Set(edit.pins), moves = new Map(edit.moves);
    const free = all.every((v) => pins.has(v));
    for (const v of all) {
      moves.delete(v);
      if (free) pins.delete(v);
      else pins.add(v);
    }
    this.change(withEdit(this.state, { ...edit, pins, moves }));
  }

  private editToChange(): HandEdit {
    return this.current ?? newEdit(this.level, this.solver, this.border);
  }

  /** Makes handles of the selected vertices. Moves and turns go from here until endDrag(). */
  beginDrag(): void {
    const edit = this.editToChange(), moves = new Map(edit.moves), pins = new Set(edit.pins);
    for (const v of this.selection) {
      if (!moves.has(v)) moves.set(v, this.followed(edit, v));
      pins.delete(v);
    }
    const held = { ...edit, moves, pins };
    this.base = { state: this.state, edit: held, places: this.places };
    this.history.preview(withEdit(this.state, held));
    this.dragging = true;
    this.changed();
  }

  /** How far a vertex has moved along with the edit's handles. */
  private followed(edit: HandEdit, v: number): readonly [number, number] {
    const moves = this.moves[this.level];
    if (!moves || moves.length === 0) return [0, 0];
    let x = moves[2 * v]!, y = moves[2 * v + 1]!;
    for (const other of this.state.edits) {
      const own = other.id !== edit.id && other.level === edit.level ? other.moves.get(v) : undefined;
      if (own) [x, y] = [x - own[0], y - own[1]];
    }
    return this.state.edits.some(({ id }) => id === edit.id) ? [x, y] : [0, 0];
  }

  /** Puts the selected vertices where `to` takes their places from the beginning of the drag. */
  drag(to: Transformation): void {
    if (!this.base) return;
    const { state, edit, places } = this.base, moves = new Map(edit.moves);
    for (const v of this.selection) {
      const x = places[2 * v]!, y = places[2 * v + 1]!, [nx, ny] = to(x, y), [mx, my] = edit.moves.get(v)!;
      moves.set(v, [withinMost(mx + nx - x), withinMost(my + ny - y)]);
    }
    this.history.preview(withEdit(state, { ...edit, moves }));
    this.request(true);
  }

  endDrag(): void {
    if (!this.base) return;
    const { state, edit } = this.base, result = this.state;
    const before = state.edits.find(({ id }) => id === edit.id), now = this.current;
    this.base = null;
    this.dragging = false;
    // A click on a handle changes nothing that undo could take back.
    if (before && now && before.pins.size === now.pins.size && sameMoves(before.moves, now.moves)) this.history.preview(state);
    else this.history.set(result, state);
    this.request(false);
    this.changed();
  }

  /** Moves, turns or scales the selected vertices by one step. */
  step(to: Transformation): void {
    if (this.selection.size === 0) return;
    this.beginDrag();
    this.drag(to);
    this.endDrag();
  }

  /** The middle of the selected vertices in the warped image. */
  middle(): { x: number; y: number; radius: number } {
    let x = 0, y = 0, radius = 0;
    for (const v of this.selection) {
      x += this.places[2 * v]! / this.selection.size;
      y += this.places[2 * v + 1]! / this.selection.size;
    }
    for (const v of this.selection) radius = Math.max(radius, Math.hypot(this.places[2 * v]! - x, this.places[2 * v + 1]! - y));
    return { x, y, radius };
  }

  select(vertices: Iterable<number>): void {
    this.selection.clear();
    for (const v of vertices) this.selection.add(v);
    this.changed();
  }

  /** Says what went wrong with the edits as they are. The line goes when they are others. */
  fail(error: unknown): void {
    this.forgetProblem = this.studio.fail(error);
  }

  private change(state: EditState): void {
    this.history.set(state);
    this.request(false);
    this.changed();
  }

  /** Solves the edits as they are now, once what is running has ended. */
  private request(drag: boolean): void {
    this.wanted = { drag };
    window.clearTimeout(this.pause);
    if (!this.running) void this.run();
  }

  private async run(): Promise<void> {
    this.running = true;
    const { session } = this;
    try {
      while (this.wanted && session && session === this.session) {
        const { drag } = this.wanted, { level } = this;
        this.wanted = null;
        const solved = await session.ask("warp.solve", { edits: asDocument(this.state), level, drag });
        if (session !== this.session) break;
        this.forgetProblem();
        this.stepTime = solved.time;
        if (level === this.level) [this.places, this.turned] = [solved.places, solved.turned];
        this.moves = solved.moves;
        this.missed = solved.missed;
        if (!drag) {
          this.folds = null;
          this.pause = window.setTimeout(() => this.rested(), kPause);
        }
        this.moved(!drag);
      }
    } catch (error) {
      // A session that was closed has nothing to say.
      if (session === this.session && session === this.studio.session) this.fail(error);
    } finally {
      this.running = false;
      if (this.wanted && this.session) void this.run();
    }
  }
}

function withinMost(move: number): number {
  return Math.min(Math.max(move, -kMostMove), kMostMove);
}

function sameMoves(a: HandEdit["moves"], b: HandEdit["moves"]): boolean {
  return a.size === b.size && [...a].every(([v, [x, y]]) => b.get(v)?.[0] === x && b.get(v)?.[1] === y);
}
