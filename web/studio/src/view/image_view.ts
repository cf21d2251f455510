// The canvas with its two sides, the split between them, and overlays.
import type { ImageView, Layer, Overlay, ViewTransform } from "../contracts";
import { addGestures } from "./gestures";
import { SplitHandle } from "./split_handle";
import { Transform } from "./transform";

/** From this zoom on, image pixels are seen as squares. */
const kSquaresFrom = 3;

export class CanvasView implements ImageView {
  readonly element = document.createElement("div");
  readonly transform = new Transform();
  private readonly canvas = document.createElement("canvas");
  private readonly split = new SplitHandle(() => this.invalidate());
  private readonly overlays: Overlay[] = [];
  private left: Layer | null = null;
  private right: Layer | null = null;
  private frame = 0;
  private readonly changed: () => void;

  /** `changed` is called after each drawing, as the zoom may be another. */
  constructor(changed: () => void = () => {}) {
    this.changed = changed;
    this.element.className = "view";
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "img");
    this.element.append(this.canvas, this.split.element);
    addGestures({
      canvas: this.canvas,
      transform: this.transform,
      overlays: () => [...this.overlays].reverse(),
      invalidate: () => this.invalidate(),
    });
    new ResizeObserver(() => this.resize()).observe(this.element);
    // The squares are those of the light or the dark theme.
    window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
      ground = null;
      this.invalidate();
    });
    this.describe("No image yet");
  }

  /** What screen readers say of the canvas. */
  describe(text: string): void {
    this.canvas.setAttribute("aria-label", `${text}. Arrow keys move it, plus and minus zoom, 0 shows all of it.`);
  }

  setSides(left: Layer | null, right: Layer | null): void {
    this.left = left;
    this.right = right;
    const size = left ?? right;
    if (size) this.transform.setImage(size.width, size.height);
    this.split.element.hidden = !left || !right || left === right;
    this.invalidate();
  }

  /** Whether these are the layers that setSides() was given last. */
  shows(left: Layer | null, right: Layer | null): boolean {
    return this.left === left && this.right === right;
  }

  addOverlay(overlay: Overlay, below = false): () => void {
    if (below) this.overlays.unshift(overlay);
    else this.overlays.push(overlay);
    this.invalidate();
    return () => {
      const at = this.overlays.indexOf(overlay);
      if (at >= 0) this.overlays.splice(at, 1);
      this.invalidate();
    };
  }

  invalidate(): void {
    this.frame ||= requestAnimationFrame(() => {
      this.frame = 0;
      this.draw();
    });
  }

  fit(): void {
    this.transform.fit();
    this.invalidate();
  }

  zoom(factor: number): void {
    this.transform.zoom(factor);
    this.invalidate();
  }

  /** Where the right side begins, in CSS pixels: at 0 where there is only one. */
  splitAt(): number {
    return this.split.element.hidden ? 0 : this.split.place(this.transform);
  }

  private resize(): void {
    const ratio = window.devicePixelRatio || 1;
    const { clientWidth, clientHeight } = this.element;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.canvas.width = Math.round(clientWidth * ratio);
    this.canvas.height = Math.round(clientHeight * ratio);
    this.transform.setCanvas(clientWidth, clientHeight, ratio);
    // At once: a canvas that was resized is empty.
    this.draw();
  }

  private draw(): void {
    const context = this.canvas.getContext("2d");
    if (!context) return;
    const t = this.transform;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    context.setTransform(t.ratio, 0, 0, t.ratio, 0, 0);
    const both = this.left && this.right && this.left !== this.right;
    const at = both ? this.split.place(t) : t.width;
    if (this.left ?? this.right) drawGround(context, t, this.left ?? this.right!);
    if (this.left) drawLayer(context, t, this.left, 0, at);
    if (both || !this.left) drawLayer(context, t, this.right, both ? at : 0, t.width);
    for (const overlay of this.overlays) {
      context.save();
      overlay.draw?.(context, t);
      context.restore();
    }
    this.changed();
  }
}

/** The part of the image that the canvas shows between `from` and `to`, in CSS pixels; null if there is none. */
function visible(t: ViewTransform, layer: Layer, from: number, to: number) {
  const left = Math.max(from, t.x, 0), right = Math.min(to, t.x + t.scale * layer.width, t.width);
  const top = Math.max(t.y, 0), bottom = Math.min(t.y + t.scale * layer.height, t.height);
  return left < right && top < bottom ? { left, top, width: right - left, height: bottom - top } : null;
}

/** Squares behind what is transparent. */
function drawGround(context: CanvasRenderingContext2D, t: ViewTransform, layer: Layer): void {
  const box = visible(t, layer, 0, t.width);
  if (!box) return;
  context.fillStyle = groundPattern(context);
  context.fillRect(box.left, box.top, box.width, box.height);
}

let ground: CanvasPattern | null = null;
function groundPattern(context: CanvasRenderingContext2D): CanvasPattern | string {
  if (ground) return ground;
  const style = getComputedStyle(context.canvas), color = (name: string): string => style.getPropertyValue(name).trim();
  const tile = new OffscreenCanvas(16, 16), c = tile.getContext("2d")!;
  c.fillStyle = color("--square-other");
  c.fillRect(0, 0, 16, 16);
  c.fillStyle = color("--square");
  c.fillRect(0, 0, 8, 8);
  c.fillRect(8, 8, 8, 8);
  ground = context.createPattern(tile, "repeat");
  return ground ?? color("--square-other");
}

function drawLayer(context: CanvasRenderingContext2D, t: ViewTransform, layer: Layer | null, from: number, to: number): void {
  const box = layer && visible(t, layer, from, to);
  if (!box) return;
  context.save();
  context.beginPath();
  context.rect(box.left, box.top, box.width, box.height);
  context.clip();
  if (typeof layer.source === "function") {
    layer.source(context, t);
  } else {
    context.imageSmoothingEnabled = layer.smooth === true || t.scale * t.ratio < kSquaresFrom;
    context.imageSmoothingQuality = t.scale * t.ratio < 1 ? "medium" : "low";
    // Only the visible part, with a pixel more around it for the smoothing.
    const sx = Math.max(Math.floor((box.left - t.x) / t.scale) - 1, 0);
    const sy = Math.max(Math.floor((box.top - t.y) / t.scale) - 1, 0);
    const ex = Math.min(Math.ceil((box.left + box.width - t.x) / t.scale) + 1, layer.width);
    const ey = Math.min(Math.ceil((box.top + box.height - t.y) / t.scale) + 1, layer.height);
    const size = sourceSize(layer.source, layer);
    const fx = size.width / layer.width, fy = size.height / layer.height;
    context.drawImage(
      layer.source, sx * fx, sy * fy, (ex - sx) * fx, (ey - sy) * fy,
      t.x + sx * t.scale, t.y + sy * t.scale, (ex - sx) * t.scale, (ey - sy) * t.scale,
    );
  }
  context.restore();
}

/** A source may have more or fewer pixels than the image. */
function sourceSize(source: CanvasImageSource, layer: Layer): { width: number; height: number } {
  if (source instanceof ImageBitmap || source instanceof HTMLCanvasElement || source instanceof OffscreenCanvas)
    return { width: source.width, height: source.height };
  if (source instanceof HTMLImageElement) return { width: source.naturalWidth, height: source.naturalHeight };
  return layer;
}
