// The ring around several selected vertices, by which they are turned and scaled.
import type { Point, ViewPointer, ViewTransform } from "../contracts";
import type { Transformation } from "./editor";

export type Grip = "turn" | "scale" | "move";
const kMargin = 18, kKnob = 7; // CSS pixels

export interface Ring extends Point {
  radius: number;
}

/** Where the grips are, in CSS pixels. */
function places(ring: Ring, t: ViewTransform): { middle: Point; radius: number; turn: Point; scale: Point } {
  const middle = t.toScreen(ring), radius = Math.max(ring.radius * t.scale + kMargin, 32);
  // A grip of a ring that the view does not show as a whole stays at the view's edge.
  const within = (x: number, size: number): number => Math.min(Math.max(x, 2 * kKnob), size - 2 * kKnob);
  const on = (degrees: number): Point => ({
    x: within(middle.x + radius * Math.cos((degrees * Math.PI) / 180), t.width),
    y: within(middle.y + radius * Math.sin((degrees * Math.PI) / 180), t.height),
  });
  return { middle, radius, turn: on(-90), scale: on(45) };
}

export function gripAt(pointer: ViewPointer, ring: Ring, t: ViewTransform): Grip | null {
  const p = t.toScreen(pointer), at = places(ring, t), reach = Math.max(pointer.tolerance * t.scale, kKnob) + 4;
  if (Math.hypot(p.x - at.turn.x, p.y - at.turn.y) < reach) return "turn";
  if (Math.hypot(p.x - at.scale.x, p.y - at.scale.y) < reach) return "scale";
  return Math.hypot(p.x - at.middle.x, p.y - at.middle.y) < reach ? "move" : null;
}

export function drawGizmo(c: CanvasRenderingContext2D, ring: Ring, t: ViewTransform, color: string): void {
  const { middle, radius, turn, scale } = places(ring, t);
  for (const [style, width] of [["rgb(0 0 0 / 55%)", 3], [color, 1.5]] as const) {
    c.strokeStyle = style;
    c.lineWidth = width;
    c.setLineDash([5, 4]);
    c.beginPath();
    c.arc(middle.x, middle.y, radius, 0, 2 * Math.PI);
    c.stroke();
  }
  c.setLineDash([]);
  c.fillStyle = "#fff";
  c.strokeStyle = "#16181a";
  c.beginPath();
  c.arc(turn.x, turn.y, kKnob, 0, 2 * Math.PI);
  c.moveTo(middle.x + 5, middle.y);
  c.arc(middle.x, middle.y, 5, 0, 2 * Math.PI);
  c.fill();
  c.stroke();
  c.beginPath();
  c.rect(scale.x - kKnob + 1, scale.y - kKnob + 1, 2 * kKnob - 2, 2 * kKnob - 2);
  c.fill();
  c.stroke();
}

export function turnedBy(degrees: number, about: Point): Transformation {
  // Counter-clockwise on screen, where y grows down.
  const cosine = Math.cos((degrees * Math.PI) / 180), sine = Math.sin((degrees * Math.PI) / 180);
  return (x, y) => [
    about.x + cosine * (x - about.x) + sine * (y - about.y),
    about.y + cosine * (y - about.y) - sine * (x - about.x),
  ];
}

export function scaledBy(factor: number, about: Point): Transformation {
  return (x, y) => [about.x + factor * (x - about.x), about.y + factor * (y - about.y)];
}

export function movedBy(dx: number, dy: number): Transformation {
  return (x, y) => [x + dx, y + dy];
}

/** What a drag of a grip from one point to another does. */
export function dragged(grip: Grip, from: Point, to: Point, about: Point): Transformation {
  if (grip === "move") return movedBy(to.x - from.x, to.y - from.y);
  if (grip === "scale") {
    const before = Math.hypot(from.x - about.x, from.y - about.y) || 1;
    return scaledBy(Math.max(Math.hypot(to.x - about.x, to.y - about.y) / before, 0.01), about);
  }
  const angle = (p: Point): number => Math.atan2(about.y - p.y, p.x - about.x);
  return turnedBy(((angle(to) - angle(from)) * 180) / Math.PI, about);
}
