// The keys of the canvas while the image is warped.
import type { Point } from "../contracts";
import type { WarpEditor } from "./editor";
import { movedBy, scaledBy, turnedBy } from "./gizmo";

const kDirections: Record<string, readonly [number, number]> = {
  ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1],
};

/** Undo and redo, wherever the focus is. */
export function undoKey(editor: WarpEditor, e: KeyboardEvent): boolean {
  if (!(e.ctrlKey || e.metaKey) || e.altKey) return false;
  const key = e.key.toLowerCase();
  if (key === "z" && !e.shiftKey) editor.undo();
  else if ((key === "z" && e.shiftKey) || key === "y") editor.redo();
  else return false;
  return true;
}

/** Returns whether the key was taken. `middle` is the image point in the middle of the view. */
export function warpKey(editor: WarpEditor, e: KeyboardEvent, middle: () => Point): boolean {
  if (undoKey(editor, e)) return true;
  const { mesh, selection, places } = editor;
  if (!mesh) return false;
  const direction = kDirections[e.key], many = e.shiftKey;
  if (direction && selection.size > 0) {
    const [dx, dy] = direction;
    if (e.ctrlKey || e.metaKey || e.altKey) {
      const last = [...selection].pop()!;
      editor.select([mesh.towards(last, dx, dy, places)]);
    } else {
      const step = many ? 10 : 1;
      editor.step(movedBy(dx * step, dy * step));
    }
    return true;
  }
  if (e.key === "Tab") return nextHandle(editor, many ? -1 : 1);
  if (e.ctrlKey || e.metaKey || e.altKey) {
    if (e.key.toLowerCase() !== "a" || !editor.current) return false;
    editor.select(editor.current.moves.keys());
    return true;
  }
  const about = selection.size > 0 ? editor.middle() : null;
  switch (e.key) {
    case "Enter": {
      const near = selection.size === 0 ? mesh.nearest(middle(), places) : null;
      if (!near) return false;
      editor.select([near.vertex]);
      return true;
    }
    case "Escape":
      if (selection.size === 0) return false;
      editor.select([]);
      return true;
    case "Delete":
    case "Backspace":
      editor.deleteSelected();
      return true;
    case "p":
    case "P":
      editor.togglePins(selection);
      return true;
    case "[":
    case "]":
    case "{":
    case "}": {
      if (!about) return false;
      const degrees = e.key === "{" || e.key === "}" ? 15 : 1;
      editor.step(turnedBy(e.key === "[" || e.key === "{" ? degrees : -degrees, about));
      return true;
    }
    case ",":
    case ".":
    case "<":
    case ">": {
      if (!about) return false;
      const factor = e.key === "<" || e.key === ">" ? 1.1 : 1.01;
      editor.step(scaledBy(e.key === "." || e.key === ">" ? factor : 1 / factor, about));
      return true;
    }
    default:
      return false;
  }
}

/** Selects the next handle; beyond the last one the focus goes on to what follows the canvas. */
function nextHandle(editor: WarpEditor, step: number): boolean {
  const handles = [...(editor.current?.moves.keys() ?? [])];
  if (handles.length === 0) return false;
  const last = [...editor.selection].pop(), at = last === undefined ? -1 : handles.indexOf(last);
  const next = at < 0 ? (step > 0 ? 0 : handles.length - 1) : at + step;
  if (next < 0 || next >= handles.length) return false;
  editor.select([handles[next]!]);
  return true;
}
