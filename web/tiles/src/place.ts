// The part of the address after '#': where the view is, so that a link shows a place.
import type { Transform } from "../../studio/src/view/transform";

/** What a link tells. */
export interface Place {
  /** The pixel in the middle of the view, and the zoom [%]: device pixels for 100 pixels. Null: all of the picture. */
  at: { x: number; y: number; zoom: number } | null;
  wire: boolean;
  tiles: boolean;
}

/** Reads "#x=12.5&y=7&zoom=50&show=wire,tiles". What is not understood is as if it were not there. */
export function readPlace(hash: string): Place {
  const values = new URLSearchParams(hash.replace(/^#/, ""));
  const number = (name: string): number => Number.parseFloat(values.get(name) ?? "");
  const at = { x: number("x"), y: number("y"), zoom: number("zoom") };
  const shown = (values.get("show") ?? "").split(",");
  return {
    at: Object.values(at).every(Number.isFinite) && at.zoom > 0 ? at : null,
    wire: shown.includes("wire"),
    tiles: shown.includes("tiles"),
  };
}

/** The inverse of readPlace; empty for all of the picture alone. */
export function writePlace({ at, wire, tiles }: Place): string {
  const parts: string[] = [];
  if (at) parts.push(`x=${+at.x.toFixed(2)}`, `y=${+at.y.toFixed(2)}`, `zoom=${+at.zoom.toPrecision(6)}`);
  const shown = [wire && "wire", tiles && "tiles"].filter(Boolean);
  if (shown.length > 0) parts.push(`show=${shown.join(",")}`);
  return parts.length > 0 ? `#${parts.join("&")}` : "";
}

/** Device pixels for 100 pixels of the picture. */
export function zoomOf(transform: Transform): number {
  return 100 * transform.scale * transform.ratio;
}

export function placeOf(transform: Transform): Place["at"] {
  if (transform.fitted) return null;
  const middle = transform.toImage({ x: transform.width / 2, y: transform.height / 2 });
  return { ...middle, zoom: zoomOf(transform) };
}

/** Moves the view there, as far as the picture stays in touch with it. */
export function goTo(transform: Transform, at: Place["at"]): void {
  if (!at) return transform.fit();
  transform.zoom(at.zoom / zoomOf(transform));
  const { x, y } = transform.toScreen(at);
  transform.pan(transform.width / 2 - x, transform.height / 2 - y);
}
