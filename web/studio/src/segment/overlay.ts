// Regions over the image: what is drawn, and what pointer and keys do to them.
import type { Regions } from "imgmesh.wasm";
import type { Overlay, Point, ViewPointer, ViewTransform } from "../contracts";
import { paintRegions, type RegionLook, type Window } from "./paint";

/** More pixels of the screen than these are drawn at half the resolution. */
const kMostPixels = 3e6;

export type Tool = "select" | "join" | "split" | "keep" | "drop";

export interface Mark {
  keep: boolean;
  line: Point[];
}

export interface RegionActions {
  readonly regions: Regions | null;
  readonly tool: Tool;
  readonly look: RegionLook | null;
  /** Is drawn under the lines in place of the image. */
  readonly ground: ImageBitmap | null;
  readonly marks: readonly Mark[];
  /** Regions that a stroke has touched so far. */
  touched(regions: ReadonlySet<number>): void;
  joined(regions: ReadonlySet<number>): void;
  marked(mark: Mark): void;
  key(event: KeyboardEvent): boolean;
}

export class RegionOverlay implements Overlay {
  private readonly actions: RegionActions;
  private readonly invalidate: () => void;
  private readonly buffer = new OffscreenCanvas(1, 1);
  /** What the buffer shows: nothing is painted anew while both are the same. */
  private shown: { look: RegionLook; place: string } | null = null;
  private stroke: Point[] | null = null;
  private touching = new Set<number>();

  constructor(actions: RegionActions, invalidate: () => void) {
    this.actions = actions;
    this.invalidate = invalidate;
  }

  draw(context: CanvasRenderingContext2D, t: ViewTransform): void {
    const { regions, look, ground } = this.actions;
    if (!regions || !look) return;
    const { width, height } = regions.data;
    if (ground) {
      context.imageSmoothingEnabled = t.scale < 1;
      context.drawImage(ground, t.x, t.y, width * t.scale, height * t.scale);
    }
    const box = this.paint(t, regions, look);
    if (box) {
      context.imageSmoothingEnabled = false;
      context.drawImage(this.buffer, 0, 0, box.width, box.height, box.x, box.y, box.width / box.ratio, box.height / box.ratio);
    }
    for (const mark of this.actions.marks) drawLine(context, t, mark.line, mark.keep ? "#1f9d55" : "#d33a2c");
    const { tool } = this.actions;
    if (this.stroke) drawLine(context, t, this.stroke, tool === "join" ? "#ffd85a" : tool === "keep" ? "#1f9d55" : "#d33a2c");
  }

  pointerDown(pointer: ViewPointer): boolean {
    const { regions, tool } = this.actions;
    if (!regions || tool === "select" || tool === "split") return false; // a drag moves the image
    if (this.region(pointer) === null) return false;
    this.stroke = [rounded(pointer)];
    this.touching = new Set();
    this.touch(pointer, pointer);
    return true;
  }

  pointerMove(pointer: ViewPointer): void {
    const last = this.stroke?.at(-1);
    if (!this.stroke || !last) return;
    const { width, height } = this.actions.regions!.data;
    const to = rounded({ x: clamp(pointer.x, width), y: clamp(pointer.y, height) });
    if (to.x === last.x && to.y === last.y) return;
    this.touch(last, to);
    this.stroke.push(to);
    this.invalidate();
  }

  pointerUp(): void {
    const { stroke } = this;
    this.stroke = null;
    if (!stroke) return;
    const { tool } = this.actions;
    if (tool === "join") this.actions.joined(this.touching);
    else this.actions.marked({ keep: tool === "keep", line: stroke });
    this.invalidate();
  }

  keyDown(event: KeyboardEvent): boolean {
    return this.actions.key(event);
  }

  region(at: Point): number | null {
    const p = rounded(at);
    return this.actions.regions?.regionAt(p.x, p.y) ?? null;
  }

  /** Notes the regions along a line. */
  private touch(from: Point, to: Point): void {
    const before = this.touching.size, steps = Math.ceil(Math.max(Math.abs(to.x - from.x), Math.abs(to.y - from.y), 1));
    for (let k = 0; k <= steps; ++k) {
      const region = this.region({ x: from.x + ((to.x - from.x) * k) / steps, y: from.y + ((to.y - from.y) * k) / steps });
      if (region !== null) this.touching.add(region);
    }
    if (this.touching.size > before) this.actions.touched(this.touching);
  }

  /** Paints the part of the image that the canvas shows, and returns where it lies. */
  private paint(t: ViewTransform, regions: Regions, look: RegionLook) {
    const { width, height } = regions.data;
    let ratio = t.ratio;
    if (t.width * t.height * ratio * ratio > kMostPixels) ratio /= 2;
    const x = Math.max(Math.ceil(t.x * ratio), 0), y = Math.max(Math.ceil(t.y * ratio), 0);
    const right = Math.min(Math.floor((t.x + width * t.scale) * ratio), Math.floor(t.width * ratio));
    const bottom = Math.min(Math.floor((t.y + height * t.scale) * ratio), Math.floor(t.height * ratio));
    const w = right - x, h = bottom - y;
    if (w <= 0 || h <= 0) return null;
    const place = [x, y, w, h, t.x, t.y, t.scale, ratio].join();
    const box = { x: x / ratio, y: y / ratio, width: w, height: h, ratio };
    if (this.shown?.look === look && this.shown.place === place) return box;
    const start = performance.now();
    const window: Window = {
      width: w,
      height: h,
      columns: places(x, w, t.x, t.scale, ratio, width),
      rows: places(y, h, t.y, t.scale, ratio, height),
    };
    const image = new ImageData(w, h);
    paintRegions(new Uint32Array(image.data.buffer), window, regions.data, look);
    if (this.buffer.width < w || this.buffer.height < h) {
      this.buffer.width = w;
      this.buffer.height = h;
    }
    this.buffer.getContext("2d")!.putImageData(image, 0, 0);
    this.shown = { look, place };
    performance.measure("regions painted", { start });
    return box;
  }
}

/** The image's column (row) below each of `count` + 1 pixels of the screen. */
function places(first: number, count: number, origin: number, scale: number, ratio: number, size: number): Int32Array {
  return Int32Array.from({ length: count + 1 }, (_, k) => Math.min(Math.max(Math.floor(((first + k + 0.5) / ratio - origin) / scale), 0), size - 1));
}

function rounded(p: Point): Point {
  return { x: Math.round(p.x), y: Math.round(p.y) };
}

function clamp(value: number, size: number): number {
  return Math.min(Math.max(value, 0), size - 1);
}

function drawLine(context: CanvasRenderingContext2D, t: ViewTransform, line: readonly Point[], color: string): void {
  context.lineCap = context.lineJoin = "round";
  for (const [width, style] of [[8, "#fff"], [5, color]] as const) {
    context.lineWidth = width;
    context.strokeStyle = style;
    context.beginPath();
    line.forEach((p, k) => {
      const at = t.toScreen(p);
      if (k === 0) context.moveTo(at.x, at.y);
      // A line without length is a dot.
      context.lineTo(at.x + (line.length === 1 ? 0.01 : 0), at.y);
    });
    context.stroke();
  }
}
