// The state of the Regions panel: what is computed, shown and edited.
import type { SegmentOptions } from "imgmesh.wasm";
import type { Session, Studio } from "../contracts";
import { contourImage } from "./contour_image";
import { RegionEditor, type Display } from "./editor";
import { RegionOverlay, type Mark, type RegionActions, type Tool } from "./overlay";
import type { RegionLook } from "./paint";

interface Settings {
  quality: "default" | "fast";
  superpixels: number | null;
}

export class SegmentWork implements RegionActions {
  editor: RegionEditor | null = null;
  tool: Tool = "select";
  look: RegionLook | null = null;
  /** The threshold that the user chose, or the height of the last merge. */
  threshold = 8;
  private readonly studio: Studio;
  private readonly progress: (fraction: number | null) => void;
  private readonly refresh: () => void;
  private readonly overlay: RegionOverlay;
  private readonly settings: Settings = { quality: "default", superpixels: null };
  private display: Display = "outlines";
  private contours: ImageBitmap | null = null;
  private session: Session | null = null;
  private remove: (() => void) | null = null;
  /** Numbers of the last computation and the last cut-out; older answers come too late. */
  private starts = 0;
  private masks = 0;
  private pressed: { x: number; y: number } | null = null;

  constructor(studio: Studio, progress: (fraction: number | null) => void, refresh: () => void) {
    this.studio = studio;
    this.progress = progress;
    this.refresh = refresh;
    this.overlay = new RegionOverlay(this, () => studio.view.invalidate());
    studio.on("mesh", () => {
      this.forget();
      if (this.remove) void this.start({});
    });
  }

  get regions() {
    return this.editor?.regions ?? null;
  }
  get cells(): number {
    return this.editor ? this.editor.regions.data.count - this.editor.regions.data.forced : 1;
  }
  get marks(): readonly Mark[] {
    return this.editor?.marks ?? [];
  }
  get ground(): ImageBitmap | null {
    return this.display === "contours" ? this.contours : null;
  }

  open(): void {
    const { element } = this.studio.view;
    const removeOverlay = this.studio.view.addOverlay(this.overlay);
    const down = (e: PointerEvent): void => void (this.pressed = { x: e.clientX, y: e.clientY });
    const click = (e: MouseEvent): void => this.click(e);
    element.addEventListener("pointerdown", down, true);
    element.addEventListener("click", click);
    this.remove = () => {
      removeOverlay();
      element.removeEventListener("pointerdown", down, true);
      element.removeEventListener("click", click);
    };
    this.showPicture();
    if (!this.editor) void this.start({});
  }
  close(): void {
    this.remove?.();
    this.remove = null;
    this.studio.showChosenSides();
  }

  /** Regions are looked at on the image alone, until the user chooses sides. */
  private showPicture(): void {
    const { picture, view } = this.studio;
    if (!picture) return;
    const layer = { width: picture.pixels.width, height: picture.pixels.height, source: picture.bitmap };
    view.setSides(layer, layer);
  }

  /** Computes regions with other settings; those of before, and all edits of them, go. */
  async start(change: Partial<Settings>): Promise<void> {
    Object.assign(this.settings, change);
    const { session } = this.studio;
    if (!session || !this.studio.facts) return;
    const { quality, superpixels } = this.settings;
    const options: SegmentOptions = superpixels === null ? { quality } : { superpixels };
    this.session = session;
    const mine = ++this.starts;
    const start = performance.now();
    this.progress(0);
    this.studio.tell("Finding regions …");
    try {
      const found = await session.ask("segment.start", { options }, [], (fraction) => mine === this.starts && this.progress(fraction));
      if (session !== this.studio.session || mine !== this.starts) return;
      this.forget();
      this.editor = new RegionEditor(found);
      this.threshold = superpixels === null ? 8 : 0;
      this.changed();
      if (this.remove) this.showPicture();
      const seconds = ((performance.now() - start) / 1000).toFixed(1);
      this.studio.tell(found.missed || `${counted(this.editor.regions.count)}, found in ${seconds} s.`);
    } catch (error) {
      if (session === this.studio.session && mine === this.starts) this.studio.fail(error);
    } finally {
      if (mine === this.starts) this.progress(null);
    }
  }

  cutTo(count: number, done: boolean): void {
    if (!this.editor) return;
    this.editor.cut(this.editor.regions.mergesFor(count, done ? 8 : 1), done);
    this.threshold = this.editor.regions.height;
    this.changed(done);
  }
  cutBelow(threshold: number): void {
    if (!this.editor) return;
    this.editor.cut(this.editor.regions.mergesBelow(threshold), true);
    this.threshold = threshold;
    this.changed();
    this.studio.tell(`${counted(this.editor.regions.count)}.`);
  }

  show(display: Display): void {
    this.display = display;
    if (display === "contours" && !this.contours && this.editor && this.studio.session) {
      const { editor } = this;
      this.studio.session.ask("segment.contours", {}).then(contourImage).then(
        (image) => {
          if (editor !== this.editor) return image.close();
          this.contours = image;
          this.studio.view.invalidate();
        },
        (error: unknown) => this.studio.fail(error),
      );
    }
    this.changed(false);
  }

  selectNext(step: number): void {
    const { editor } = this;
    if (!editor) return;
    const { count } = editor.regions;
    this.select(editor.selected === null ? 0 : (editor.selected + step + count) % count);
  }
  select(region: number | null): void {
    const { editor } = this;
    if (!editor) return;
    editor.select(region);
    this.changed(false);
    if (region === null) return;
    const pixels = Math.round(editor.regions.means()[4 * region]!);
    this.studio.tell(`Region ${region + 1} of ${editor.regions.count}: ${pixels} ${pixels === 1 ? "pixel" : "pixels"}.`);
  }
  joinSelected(region = this.editor?.selected ?? null): void {
    if (!this.editor || region === null) return;
    const other = this.editor.regions.mostAlike(region);
    if (other === null) return this.studio.tell("This region has no neighbour.");
    this.editor.select(region);
    this.joined(new Set([region, other]));
  }
  splitSelected(region = this.editor?.selected ?? null): void {
    if (!this.editor || region === null) return;
    this.editor.select(region);
    const done = this.editor.split(region);
    this.changed();
    this.studio.tell(done ? `Split in two: ${counted(this.editor.regions.count)}.` : "This region is one piece of the mesh. A mesh with more vertices has smaller ones.");
  }

  touched(regions: ReadonlySet<number>): void {
    if (!this.editor || this.tool !== "join") return;
    this.editor.touched = new Set(regions);
    this.changed(false);
  }
  joined(regions: ReadonlySet<number>): void {
    const { editor } = this;
    if (!editor) return;
    editor.touched = new Set();
    const [only] = regions;
    if (regions.size === 1 && only !== undefined) return this.joinSelected(only);
    const fewer = editor.join(regions);
    this.changed();
    this.studio.tell(fewer > 0 ? `${fewer + 1} regions became one.` : "These regions do not touch.");
  }
  marked(mark: Mark): void {
    if (!this.editor) return;
    this.editor.mark([...this.editor.marks, mark]);
    this.changed();
  }
  undo(): void {
    if (this.editor?.undo()) this.changed();
  }
  redo(): void {
    if (this.editor?.redo()) this.changed();
  }
  reset(): void {
    this.editor?.reset();
    this.changed();
  }

  key(event: KeyboardEvent): boolean {
    if (!this.editor) return false;
    const key = event.key.toLowerCase();
    if (event.ctrlKey || event.metaKey) {
      if (key === "z" && !event.shiftKey) this.undo();
      else if (key === "y" || key === "z") this.redo();
      else return false;
      return true;
    }
    if (key === "n") this.selectNext(event.shiftKey ? -1 : 1);
    else if (key === "j" || key === "m") this.joinSelected();
    else if (key === "s") this.splitSelected();
    else if ((key === "k" || key === "d") && this.editor.selected !== null) this.markSelected(key === "k");
    else if (key === "escape" && this.editor.selected !== null) this.select(null);
    else return false;
    return true;
  }

  /** Marks a pixel of the selected region: the first of its cell. */
  private markSelected(keep: boolean): void {
    const { editor } = this;
    if (!editor || editor.selected === null) return;
    const { cells, width } = editor.regions.data, cell = editor.regions.table.indexOf(editor.selected);
    const at = cells.indexOf(cell);
    this.marked({ keep, line: [{ x: at % width, y: Math.floor(at / width) }] });
  }

  private click(e: MouseEvent): void {
    const { pressed } = this;
    if (!this.editor || !pressed || (this.tool !== "select" && this.tool !== "split")) return;
    if (!(e.target instanceof HTMLCanvasElement) || Math.hypot(e.clientX - pressed.x, e.clientY - pressed.y) > 4) return;
    const box = e.target.getBoundingClientRect();
    const region = this.overlay.region(this.studio.view.transform.toImage({ x: e.clientX - box.left, y: e.clientY - box.top }));
    if (this.tool === "select") this.select(region === this.editor.selected ? null : region);
    else this.splitSelected(region);
  }

  /** Shows what is there now. A new cut-out is asked for when a step is done. */
  private changed(done = true): void {
    const { editor } = this;
    this.look = editor ? editor.look(this.display) : null;
    if (done && editor) this.cutOut(editor);
    this.refresh();
    this.studio.view.invalidate();
  }

  private cutOut(editor: RegionEditor): void {
    const mine = ++this.masks, { session } = this;
    if (editor.marks.length === 0 || !session) {
      if (!editor.inside) return;
      editor.setInside(null);
      this.look = editor.look(this.display);
      return;
    }
    session.ask("segment.mask", { table: editor.regions.table.slice(), keep: editor.lines(true), drop: editor.lines(false) }).then(
      (inside) => {
        if (mine !== this.masks || editor !== this.editor) return;
        editor.setInside(inside);
        this.changed(false);
      },
      (error: unknown) => {
        if (mine !== this.masks || editor !== this.editor) return;
        // What cannot be, such as one place both kept and dropped, does not stay.
        if (editor.dropLastMark()) this.changed();
        this.studio.fail(error);
      },
    );
  }

  private forget(): void {
    this.editor = null;
    this.look = null;
    this.contours?.close();
    this.contours = null;
    this.refresh();
    this.studio.view.invalidate();
  }
}

function counted(regions: number): string {
  return regions === 1 ? "1 region" : `${regions} regions`;
}
