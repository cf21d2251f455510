// Pointer, wheel and keys of the view: pan, zoom, and what overlays take.
import type { Overlay, Point, ViewPointer } from "../contracts";
import type { Transform } from "./transform";

/** How far one may miss a point on the screen, in CSS pixels. */
const kMouseTolerance = 8;
const kTouchTolerance = 20;
const kKeyStep = 48;
const kKeyZoom = 1.25;

export interface GestureHost {
  readonly canvas: HTMLCanvasElement;
  readonly transform: Transform;
  /** The topmost comes first. */
  overlays(): Iterable<Overlay>;
  invalidate(): void;
}

export function addGestures({ canvas, transform, overlays, invalidate }: GestureHost): void {
  const touches = new Map<number, Point>();
  let taken: { overlay: Overlay; id: number } | null = null;
  let panning: number | null = null;
  let spaceHeld = false;
  let overlaysLast = false; // whether an overlay took the last press

  const local = (e: MouseEvent): Point => {
    const box = canvas.getBoundingClientRect();
    return { x: e.clientX - box.left, y: e.clientY - box.top };
  };
  const viewPointer = (e: PointerEvent): ViewPointer => ({
    ...transform.toImage(local(e)),
    shift: e.shiftKey,
    alt: e.altKey,
    ctrl: e.ctrlKey || e.metaKey,
    tolerance: (e.pointerType === "touch" ? kTouchTolerance : kMouseTolerance) / transform.scale,
  });
  const change = (work: () => void): void => {
    work();
    invalidate();
  };

  /** Two fingers: their middle pans, their distance zooms. */
  const pinch = (id: number, to: Point): void => {
    const other = [...touches].find(([key]) => key !== id)?.[1];
    const from = touches.get(id);
    if (!other || !from) return;
    const distance = (a: Point): number => Math.max(Math.hypot(a.x - other.x, a.y - other.y), 1);
    change(() => {
      transform.pan((to.x - from.x) / 2, (to.y - from.y) / 2);
      transform.zoom(distance(to) / distance(from), { x: (to.x + other.x) / 2, y: (to.y + other.y) / 2 });
    });
  };

  canvas.addEventListener("pointerdown", (e) => {
    canvas.focus({ preventScroll: true });
    canvas.setPointerCapture(e.pointerId);
    touches.set(e.pointerId, local(e));
    if (touches.size === 2 && taken) {
      // A second finger: what began as a drag becomes a pinch.
      taken.overlay.pointerUp?.(viewPointer(e));
      taken = null;
    }
    if (touches.size > 1) return;
    overlaysLast = false;
    if (e.button === 0 && !spaceHeld)
      for (const overlay of overlays())
        if (overlay.pointerDown?.(viewPointer(e))) {
          taken = { overlay, id: e.pointerId };
          overlaysLast = true;
          return;
        }
    if (e.button === 1) e.preventDefault();
    panning = e.pointerId;
    canvas.classList.add("panning");
  });
  canvas.addEventListener("pointermove", (e) => {
    const to = local(e), from = touches.get(e.pointerId);
    if (!from) {
      for (const overlay of overlays()) overlay.pointerHover?.(viewPointer(e));
      return;
    }
    if (touches.size > 1) pinch(e.pointerId, to);
    else if (taken?.id === e.pointerId) taken.overlay.pointerMove?.(viewPointer(e));
    else if (panning === e.pointerId) change(() => transform.pan(to.x - from.x, to.y - from.y));
    touches.set(e.pointerId, to);
  });
  const release = (e: PointerEvent): void => {
    touches.delete(e.pointerId);
    if (taken?.id === e.pointerId) {
      taken.overlay.pointerUp?.(viewPointer(e));
      taken = null;
    }
    // The finger that stays after a pinch goes on to pan.
    panning = touches.size === 1 && !taken ? ([...touches.keys()][0] ?? null) : null;
    canvas.classList.toggle("panning", panning !== null);
  };
  canvas.addEventListener("pointerup", release);
  canvas.addEventListener("pointercancel", release);

  canvas.addEventListener(
    "wheel",
    (e) => {
      e.preventDefault();
      const lines = e.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 : 1;
      // A pinch on a touchpad comes as a wheel with Ctrl, in small steps.
      const speed = e.ctrlKey ? 0.01 : 0.0016;
      change(() => transform.zoom(Math.exp(-e.deltaY * lines * speed), local(e)));
    },
    { passive: false },
  );
  canvas.addEventListener("dblclick", () => !overlaysLast && change(() => transform.fit()));

  canvas.addEventListener("keydown", (e) => {
    for (const overlay of overlays())
      if (overlay.keyDown?.(e)) {
        e.preventDefault();
        return;
      }
    if (e.ctrlKey || e.metaKey || e.altKey) return;
    const step = e.shiftKey ? 4 * kKeyStep : kKeyStep;
    const actions: Record<string, () => void> = {
      "+": () => transform.zoom(kKeyZoom),
      "=": () => transform.zoom(kKeyZoom),
      "-": () => transform.zoom(1 / kKeyZoom),
      "0": () => transform.fit(),
      "1": () => transform.zoom(1 / transform.scale / transform.ratio),
      ArrowLeft: () => transform.pan(step, 0),
      ArrowRight: () => transform.pan(-step, 0),
      ArrowUp: () => transform.pan(0, step),
      ArrowDown: () => transform.pan(0, -step),
      " ": () => (spaceHeld = true),
    };
    const action = actions[e.key];
    if (!action) return;
    e.preventDefault();
    change(action);
    canvas.classList.toggle("grab", spaceHeld);
  });
  const letGo = (): void => {
    spaceHeld = false;
    canvas.classList.remove("grab");
  };
  canvas.addEventListener("keyup", (e) => e.key === " " && letGo());
  canvas.addEventListener("blur", letGo);
}
