// Where the image lies on the canvas.
import type { Point, ViewTransform } from "../contracts";

/** The largest zoom: CSS pixels that an image pixel may take. */
const kLargestScale = 64;
/** Free space around a fitted image, in CSS pixels. */
const kMargin = 12;

/** A ViewTransform that can be changed. The image always keeps in touch with the canvas. */
export class Transform implements ViewTransform {
  scale = 1;
  x = 0;
  y = 0;
  width = 1;
  height = 1;
  ratio = 1;
  /** Whether the image follows the size of the canvas. */
  fitted = true;
  private imageWidth = 1;
  private imageHeight = 1;

  toScreen(p: Point): Point {
    return { x: this.x + (p.x + 0.5) * this.scale, y: this.y + (p.y + 0.5) * this.scale };
  }

  toImage(p: Point): Point {
    return { x: (p.x - this.x) / this.scale - 0.5, y: (p.y - this.y) / this.scale - 0.5 };
  }

  /** Takes on an image of another size. Images of the same size are compared, so the place stays. */
  setImage(width: number, height: number): void {
    if (width === this.imageWidth && height === this.imageHeight) return;
    this.imageWidth = width;
    this.imageHeight = height;
    this.fit();
  }

  setCanvas(width: number, height: number, ratio: number): void {
    const dx = (width - this.width) / 2, dy = (height - this.height) / 2;
    this.width = width;
    this.height = height;
    this.ratio = ratio;
    if (this.fitted) return this.fit();
    this.x += dx;
    this.y += dy;
    this.keepInTouch();
  }

  /** The scale at which the whole image is seen; small images are enlarged to be seen at all. */
  get fitScale(): number {
    const scale = Math.min((this.width - 2 * kMargin) / this.imageWidth, (this.height - 2 * kMargin) / this.imageHeight);
    return Math.min(Math.max(scale, 1e-3), kLargestScale);
  }

  fit(): void {
    this.fitted = true;
    this.scale = this.fitScale;
    this.x = (this.width - this.scale * this.imageWidth) / 2;
    this.y = (this.height - this.scale * this.imageHeight) / 2;
  }

  /** Zooms by a factor; the point `at` of the canvas stays where it is. */
  zoom(factor: number, at: Point = { x: this.width / 2, y: this.height / 2 }): void {
    const least = Math.min(this.fitScale, 1) / 2;
    const scale = Math.min(Math.max(this.scale * factor, least), kLargestScale);
    this.x = at.x - ((at.x - this.x) * scale) / this.scale;
    this.y = at.y - ((at.y - this.y) * scale) / this.scale;
    this.scale = scale;
    this.fitted = false;
    this.keepInTouch();
  }

  pan(dx: number, dy: number): void {
    this.x += dx;
    this.y += dy;
    this.fitted = false;
    this.keepInTouch();
  }

  /** A quarter of the canvas, or all of a smaller image, stays visible. */
  private keepInTouch(): void {
    const clamp = (at: number, size: number, canvas: number): number => {
      const seen = Math.min(size, canvas / 4);
      return Math.min(Math.max(at, seen - size), canvas - seen);
    };
    this.x = clamp(this.x, this.scale * this.imageWidth, this.width);
    this.y = clamp(this.y, this.scale * this.imageHeight, this.height);
  }
}
