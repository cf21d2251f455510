// The view: the canvas of the tiles, their borders above it, and what moves it.
import { addGestures } from "../../studio/src/view/gestures";
import { Transform } from "../../studio/src/view/transform";
import { drawFrames } from "./frames";
import { TileScene, type SceneEvents } from "./tile_scene";

export class TileView {
  readonly transform = new Transform();
  readonly scene: TileScene;
  frames = false;
  private readonly stage: HTMLElement;
  private readonly canvas = document.createElement("canvas");
  private readonly overlay = document.createElement("canvas");
  private readonly drawn: () => void;
  private frame = 0;

  /** `drawn` is called after each drawing. Throws if the browser cannot draw tiles. */
  constructor(stage: HTMLElement, events: Omit<SceneEvents, "changed">, drawn: () => void) {
    this.stage = stage;
    this.drawn = drawn;
    this.scene = new TileScene(this.canvas, {
      ...events,
      changed: () => this.invalidate(),
      opened: (size) => {
        this.transform.setImage(size.width, size.height);
        events.opened(size);
      },
    });
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "img");
    this.overlay.className = "frames";
    this.overlay.setAttribute("aria-hidden", "true");
    this.stage.append(this.canvas, this.overlay);
    addGestures({ canvas: this.canvas, transform: this.transform, overlays: () => [], invalidate: () => this.invalidate() });
    new ResizeObserver(() => this.resize()).observe(this.stage);
    this.describe("No tile set yet");
    this.resize();
  }

  /** What screen readers say of the canvas. */
  describe(text: string): void {
    this.canvas.setAttribute("aria-label", `${text}. Arrow keys move it, plus and minus zoom, 0 shows all of it, 1 shows it at 100 %.`);
  }

  /** Calls `moved` with the pixel under the pointer; with null once it has left. */
  onPointer(moved: (pixel: { x: number; y: number } | null) => void): void {
    this.canvas.addEventListener("pointermove", (e) => {
      const box = this.canvas.getBoundingClientRect();
      moved(this.transform.toImage({ x: e.clientX - box.left, y: e.clientY - box.top }));
    });
    this.canvas.addEventListener("pointerleave", () => moved(null));
  }

  invalidate(): void {
    this.frame ||= requestAnimationFrame(() => {
      this.frame = 0;
      this.draw();
    });
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.stage;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.transform.setCanvas(clientWidth, clientHeight, window.devicePixelRatio || 1);
    this.invalidate();
  }

  private draw(): void {
    this.scene.draw(this.transform);
    drawFrames(this.overlay, this.frames ? this.scene.shown() : [], this.transform);
    this.drawn();
  }
}
