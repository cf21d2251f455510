// A canvas for WebGL below that of the view. Unlike what is copied onto the view's canvas, a drawing here is handed to the
// screen as it is: the script does not wait for it.
import type { ViewTransform } from "../contracts";

export class GlStage {
  /** Is called when the context was lost and is there again, empty. */
  restored: () => void = () => {};
  private readonly canvas = document.createElement("canvas");
  private readonly context: WebGL2RenderingContext | null;

  /** Puts the canvas before `view`. */
  constructor(view: HTMLElement) {
    this.canvas.className = "warp-gl";
    this.canvas.setAttribute("aria-hidden", "true");
    this.canvas.hidden = true;
    this.context = this.canvas.getContext("webgl2", { antialias: false, premultipliedAlpha: true });
    this.canvas.addEventListener("webglcontextlost", (e) => e.preventDefault());
    this.canvas.addEventListener("webglcontextrestored", () => this.restored());
    view.before(this.canvas);
  }

  /** Null where the browser has no WebGL 2, and while the context is lost. */
  get gl(): WebGL2RenderingContext | null {
    return this.context && !this.context.isContextLost() ? this.context : null;
  }

  /** Clears, and lets drawings reach only what the view shows of an image of this size. */
  begin(gl: WebGL2RenderingContext, view: CanvasRenderingContext2D, t: ViewTransform, size: { width: number; height: number }): void {
    const { width, height } = view.canvas;
    this.canvas.hidden = false;
    if (this.canvas.width !== width || this.canvas.height !== height) [this.canvas.width, this.canvas.height] = [width, height];
    gl.viewport(0, 0, width, height);
    gl.disable(gl.SCISSOR_TEST);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const left = Math.round(t.x * t.ratio), right = Math.round((t.x + size.width * t.scale) * t.ratio);
    const top = Math.round(t.y * t.ratio), bottom = Math.round((t.y + size.height * t.scale) * t.ratio);
    gl.enable(gl.SCISSOR_TEST);
    // The ground behind what is transparent is the canvas's own.
    this.canvas.style.clipPath = `inset(${t.y}px ${t.width - t.x - size.width * t.scale}px ${t.height - t.y - size.height * t.scale}px ${t.x}px)`;
    gl.scissor(left, height - bottom, right - left, bottom - top);
  }

  /** Until begin() is called again. */
  hide(): void {
    this.canvas.hidden = true;
  }

  remove(): void {
    this.canvas.remove();
    this.context?.getExtension("WEBGL_lose_context")?.loseContext();
  }
}
