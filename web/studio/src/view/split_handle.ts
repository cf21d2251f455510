// The line between the two sides, and the handle that moves it.
import type { ViewTransform } from "../contracts";

const kStep = 0.02;

export class SplitHandle {
  readonly element = document.createElement("div");
  /** Share of the canvas's width that belongs to the left side. */
  private share = 0.5;
  private readonly moved: () => void;

  constructor(moved: () => void) {
    this.moved = moved;
    const e = this.element;
    e.className = "split";
    e.tabIndex = 0;
    e.setAttribute("role", "slider");
    e.setAttribute("aria-label", "Split between the left and the right view");
    e.setAttribute("aria-valuemin", "0");
    e.setAttribute("aria-valuemax", "100");
    e.append(document.createElement("span"));
    e.addEventListener("pointerdown", (down) => {
      down.preventDefault();
      e.focus();
      e.setPointerCapture(down.pointerId);
    });
    e.addEventListener("pointermove", (move) => {
      if (!e.hasPointerCapture(move.pointerId)) return;
      const box = e.parentElement!.getBoundingClientRect();
      this.set((move.clientX - box.left) / box.width);
    });
    e.addEventListener("dblclick", () => this.set(0.5));
    e.addEventListener("keydown", (key) => {
      const to: Record<string, number> = {
        ArrowLeft: this.share - kStep, ArrowDown: this.share - kStep,
        ArrowRight: this.share + kStep, ArrowUp: this.share + kStep,
        PageDown: this.share - 5 * kStep, PageUp: this.share + 5 * kStep,
        Home: 0, End: 1,
      };
      const share = to[key.key];
      if (share === undefined) return;
      key.preventDefault();
      this.set(share);
    });
    this.set(0.5);
  }

  /** Where the split lies, in CSS pixels. */
  place(t: ViewTransform): number {
    return Math.round(this.share * t.width * t.ratio) / t.ratio;
  }

  private set(share: number): void {
    this.share = Math.min(Math.max(share, 0), 1);
    this.element.style.left = `${100 * this.share}%`;
    const percent = String(Math.round(100 * this.share));
    this.element.setAttribute("aria-valuenow", percent);
    this.element.setAttribute("aria-valuetext", `${percent} % left view`);
    this.moved();
  }
}
