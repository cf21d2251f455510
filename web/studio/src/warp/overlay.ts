// What lies over the image while it is warped: wires, vertices, handles, pins and folds; and the hand's pointer.
import type { Overlay, Point, ViewPointer, ViewTransform } from "../contracts";
import { wireOverlay, type MovableWire } from "../layers/wire";
import type { WarpEditor } from "./editor";
import { dragged, drawGizmo, gripAt, type Grip } from "./gizmo";
import { warpKey } from "./keys";

/** All vertices are drawn where they are usually so far apart, in CSS pixels: with less, dots cover the picture. */
const kDotsFrom = 12;
/** Else those so near to the pointer, in CSS pixels. */
const kDotsNear = 56;
/** How near a click must be to take a vertex, in CSS pixels. */
const kReach = 64;
const kAccent = "#63e0cf", kPin = "#ffb454", kBad = "rgb(255 60 40 / 60%)", kDark = "#101214";

type Drag =
  | { kind: "grip"; grip: Grip; from: Point; about: Point; moved: boolean }
  | { kind: "area"; path: Point[]; lasso: boolean; add: boolean };

export class WarpOverlay implements Overlay {
  private readonly editor: WarpEditor;
  private readonly invalidate: () => void;
  private readonly transform: () => ViewTransform;
  private wire: MovableWire | null = null;
  private wireOf: unknown = null;
  private hover: number | null = null;
  private pointer: Point | null = null;
  private active: Drag | null = null;

  /** Whether the wires have been drawn already, below. */
  hasWires: () => boolean = () => false;

  constructor(editor: WarpEditor, transform: () => ViewTransform, invalidate: () => void) {
    this.editor = editor;
    this.transform = transform;
    this.invalidate = invalidate;
  }

  /** The vertex that a pointer means: one that is held or selected before others. */
  private vertexAt(pointer: ViewPointer): number | null {
    const { mesh, places, current, selection } = this.editor;
    if (!mesh) return null;
    const special = mesh.nearest(pointer, places, (v) => selection.has(v) || current?.moves.has(v) === true || current?.pins.has(v) === true);
    if (special && special.distance <= pointer.tolerance) return special.vertex;
    const reach = Math.max(pointer.tolerance, kReach / this.transform().scale);
    const nearest = mesh.nearest(pointer, places);
    return nearest && nearest.distance <= reach ? nearest.vertex : null;
  }

  pointerDown(pointer: ViewPointer): boolean {
    const { editor } = this, vertex = this.vertexAt(pointer);
    if (!editor.mesh) return false;
    if (editor.tool !== "select" && editor.selection.size > 1 && !pointer.shift) {
      const ring = editor.middle(), grip = gripAt(pointer, ring, this.transform());
      if (grip) return this.grab(grip, pointer, ring);
    }
    if (editor.tool === "pin" && vertex !== null) {
      editor.togglePins([vertex]);
      return true;
    }
    if (editor.tool === "move" && vertex !== null && !pointer.shift) {
      if (!editor.selection.has(vertex)) editor.select([vertex]);
      return this.grab("move", pointer, pointer);
    }
    if (editor.tool === "pin" || (editor.tool === "move" && !pointer.shift)) {
      if (editor.selection.size > 0) editor.select([]);
      return false; // pans
    }
    // Shift or the selecting tool: one vertex, or all within what is drawn.
    this.active = { kind: "area", path: [pointer], lasso: editor.tool === "select", add: pointer.shift };
    return true;
  }

  private grab(grip: Grip, from: Point, about: Point): boolean {
    this.active = { kind: "grip", grip, from: { x: from.x, y: from.y }, about: { x: about.x, y: about.y }, moved: false };
    this.editor.beginDrag();
    return true;
  }

  pointerMove(pointer: ViewPointer): void {
    const drag = this.active;
    if (!drag) return;
    if (drag.kind === "area") {
      drag.path.push({ x: pointer.x, y: pointer.y });
      this.invalidate();
      return;
    }
    // A click may tremble a little.
    const scale = this.transform().scale;
    if (!drag.moved && Math.hypot(pointer.x - drag.from.x, pointer.y - drag.from.y) * scale < 3) return;
    drag.moved = true;
    this.editor.drag(dragged(drag.grip, drag.from, pointer, drag.about));
    this.invalidate();
  }

  pointerUp(pointer: ViewPointer): void {
    const drag = this.active, { editor } = this;
    this.active = null;
    if (!drag) return;
    if (drag.kind === "grip") return editor.endDrag();
    const chosen = new Set(drag.add ? editor.selection : []);
    const far = drag.path.some((p) => Math.hypot(p.x - drag.path[0]!.x, p.y - drag.path[0]!.y) * this.transform().scale > 4);
    if (!far) {
      const vertex = this.vertexAt(pointer);
      if (vertex !== null && !chosen.delete(vertex)) chosen.add(vertex);
    } else {
      const { places, mesh } = editor, inside = drag.lasso ? inPath(drag.path) : inBox(drag.path);
      for (let v = 0; v < mesh!.count; ++v) if (inside(places[2 * v]!, places[2 * v + 1]!)) chosen.add(v);
    }
    editor.select(chosen);
  }

  pointerHover(pointer: ViewPointer): void {
    const vertex = this.vertexAt(pointer), changed = vertex !== this.hover;
    this.hover = vertex;
    this.pointer = { x: pointer.x, y: pointer.y };
    if (changed || !this.dotsFit(this.transform())) this.invalidate();
  }

  keyDown(event: KeyboardEvent): boolean {
    return warpKey(this.editor, event, () => this.transform().toImage({ x: this.transform().width / 2, y: this.transform().height / 2 }));
  }

  /** The wires as they are now; null without a mesh. */
  wires(): MovableWire | null {
    const { mesh, places } = this.editor;
    if (!mesh) return null;
    if (this.wireOf !== mesh) [this.wire, this.wireOf] = [wireOverlay(mesh.arrays, (mesh.spacing ** 2 * mesh.arrays.faces.length) / 6), mesh];
    this.wire!.move(places);
    return this.wire;
  }

  private dotsFit(t: ViewTransform): boolean {
    return !this.editor.mesh || this.editor.mesh.gap * t.scale >= kDotsFrom;
  }

  draw(c: CanvasRenderingContext2D, t: ViewTransform): void {
    const { editor } = this, { mesh, places } = editor;
    if (!mesh) return;
    if (!this.hasWires()) this.wires()!.draw!(c, t);
    this.drawFolds(c, t);
    const at = (v: number): Point => t.toScreen({ x: places[2 * v]!, y: places[2 * v + 1]! });
    const dot = (v: number, radius: number, fill: string, square = false): void => {
      const p = at(v);
      if (p.x < -9 || p.y < -9 || p.x > t.width + 9 || p.y > t.height + 9) return;
      c.beginPath();
      if (square) c.rect(p.x - radius, p.y - radius, 2 * radius, 2 * radius);
      else c.arc(p.x, p.y, radius, 0, 2 * Math.PI);
      c.fillStyle = fill;
      c.strokeStyle = kDark;
      c.lineWidth = 1.25;
      c.fill();
      c.stroke();
    };
    const edit = editor.current, border = edit?.border ?? editor.border;
    const follows = (edit?.solver ?? editor.solver) !== "direct";
    const pointer = this.active ? null : this.pointer, fit = this.dotsFit(t), reach = kDotsNear / t.scale;
    for (let v = 0; (fit || pointer) && v < mesh.count; ++v)
      if (fit || Math.hypot(places[2 * v]! - pointer!.x, places[2 * v + 1]! - pointer!.y) <= reach) dot(v, 2.2, "#fff");
    if (border && follows) for (let v = 0; v < mesh.count; ++v) if (mesh.border[v]) dot(v, 2.5, kPin, true);
    for (const v of edit?.pins ?? []) dot(v, 4.5, kPin, true);
    for (const v of edit?.moves.keys() ?? []) if (!editor.selection.has(v)) dot(v, 5, kAccent);
    if (this.hover !== null && this.hover < mesh.count && !this.active) dot(this.hover, 5, "rgb(255 255 255 / 75%)");
    for (const v of editor.selection) dot(v, editor.selection.size > 200 ? 3 : 6, "#fff");
    for (const v of editor.selection) dot(v, editor.selection.size > 200 ? 1.5 : 3, "#0b6b62");
    if (editor.selection.size > 1 && editor.tool !== "select") drawGizmo(c, editor.middle(), t, kAccent);
    if (this.active?.kind === "area") drawArea(c, t, this.active.path, this.active.lasso);
  }

  private drawFolds(c: CanvasRenderingContext2D, t: ViewTransform): void {
    const { mesh, places, turned, folds } = this.editor, faces = mesh!.arrays.faces;
    if (turned.length > 0) {
      c.beginPath();
      for (const f of turned) {
        if (3 * f + 2 >= faces.length) return;
        for (let k = 0; k < 3; ++k) {
          const v = faces[3 * f + k]!, p = t.toScreen({ x: places[2 * v]!, y: places[2 * v + 1]! });
          if (k === 0) c.moveTo(p.x, p.y);
          else c.lineTo(p.x, p.y);
        }
        c.closePath();
      }
      c.fillStyle = kBad;
      c.strokeStyle = "#ff4630";
      c.lineWidth = 1.5;
      c.fill();
      c.stroke();
    }
    const size = Math.max(t.scale, 2);
    c.fillStyle = kBad;
    for (let i = 0; folds && i < folds.places.length; i += 2) {
      const p = t.toScreen({ x: folds.places[i]!, y: folds.places[i + 1]! });
      c.fillRect(p.x - size / 2, p.y - size / 2, size, size);
    }
  }
}

function inBox(path: readonly Point[]): (x: number, y: number) => boolean {
  const a = path[0]!, b = path[path.length - 1]!;
  return (x, y) => (x - a.x) * (x - b.x) <= 0 && (y - a.y) * (y - b.y) <= 0;
}

/** By the number of sides that a ray to the right crosses. */
function inPath(path: readonly Point[]): (x: number, y: number) => boolean {
  return (x, y) => {
    let inside = false;
    for (let i = 0, j = path.length - 1; i < path.length; j = i++) {
      const a = path[i]!, b = path[j]!;
      if (a.y > y !== b.y > y && x < a.x + ((y - a.y) / (b.y - a.y)) * (b.x - a.x)) inside = !inside;
    }
    return inside;
  };
}

function drawArea(c: CanvasRenderingContext2D, t: ViewTransform, path: readonly Point[], lasso: boolean): void {
  const corners = path.map((p) => t.toScreen(p));
  c.beginPath();
  if (lasso) {
    corners.forEach((p, i) => (i === 0 ? c.moveTo(p.x, p.y) : c.lineTo(p.x, p.y)));
    c.closePath();
  } else {
    const a = corners[0]!, b = corners[corners.length - 1]!;
    c.rect(a.x, a.y, b.x - a.x, b.y - a.y);
  }
  c.fillStyle = "rgb(99 224 207 / 18%)";
  c.strokeStyle = kAccent;
  c.lineWidth = 1.5;
  c.fill();
  c.stroke();
}
