// The panel that warps the image by hand.
import type { WarpSolver } from "imgmesh.wasm";
import type { Panel, Studio } from "../contracts";
import { h } from "../ui/dom";
import { choiceField } from "../ui/fields";
import type { HandEdit } from "./edits";
import { WarpEditor, type Tool } from "./editor";
import { makeExports } from "./exports";
import { undoKey } from "./keys";
import { makeNumbers } from "./numbers";
import { WarpOverlay } from "./overlay";
import { WarpedLayer } from "./warped_layer";

const kSolvers: readonly { id: WarpSolver; label: string; help: string }[] = [
  { id: "arap", label: "As rigid as possible", help: "What is not held follows, turned rather than stretched. Pins hold the rest." },
  { id: "injective", label: "Never fold", help: "As before, and no triangle ever turns over; a handle stops where it would." },
  { id: "direct", label: "Handles only", help: "Only the handles move, and the triangles around them stretch." },
];
const kTools: readonly { id: Tool; label: string; title: string }[] = [
  { id: "move", label: "Move", title: "Click on a vertex to make a handle, and drag it. Shift-click adds one to those selected" },
  { id: "select", label: "Select", title: "Draw around vertices to move, turn and scale them together" },
  { id: "pin", label: "Pin", title: "Click on vertices that are to stay" },
];

/** `buildLevels` meshes the image again, as a pyramid. */
export function makeWarpPanel(studio: Studio, buildLevels: (levels: number) => void): Panel {
  const { view } = studio, editor = new WarpEditor(studio);
  const overlay = new WarpOverlay(editor, () => view.transform, () => view.invalidate());
  let removeOverlay: (() => void) | null = null;
  let warped: WarpedLayer | null = null;
  let open = false, stale = true, holding = false;

  const level = choiceField<string>("Level", [], (value) => void editor.chooseLevel(Number(value)).catch((e: unknown) => studio.fail(e)));
  const solver = choiceField<WarpSolver>("The rest of the image", kSolvers, (value) => editor.setSolver(value));
  const border = h("input", { type: "checkbox", change: () => editor.setBorder(border.checked) });
  const split = h("input", { type: "checkbox", change: showSides });
  const tools = kTools.map(({ id, label, title }) =>
    h("button", { type: "button", title, "aria-pressed": "false", click: () => { editor.tool = id; update(); } }, label));
  const button = (label: string, title: string, click: () => void): HTMLButtonElement => h("button", { type: "button", title, click }, label);
  const undo = button("Undo", "Ctrl+Z", () => editor.undo()), redo = button("Redo", "Ctrl+Shift+Z", () => editor.redo());
  const remove = button("Delete", "Takes the selected handles and pins away (key Delete)", () => editor.deleteSelected());
  const reset = button("Reset", "Takes all edits away", () => editor.reset());
  const another = button("New edit", "The next handle begins another edit, which adds to those before", () => editor.beginEdit());
  const before = h("button", { type: "button", title: "Shows the image as it was, while it is held", "aria-pressed": "false" }, "Hold for before");
  const facts = h("p", { class: "note", "aria-live": "polite" }), folds = h("p", { class: "warp-folds", role: "status" });
  const list = h("ul", { class: "warp-edits" });
  const pyramid = h("div", { class: "warp-offer", hidden: true },
    h("p", {}, "This mesh has one level. Coarser levels make large, smooth edits easy."),
    button("Build 3 levels", "Meshes the image again; edits stay", () => buildLevels(3)));
  const slow = h("p", { class: "note", hidden: true }, "This browser has no WebGL 2, so drags are drawn coarsely and more slowly.");
  const exports = makeExports(studio, editor);

  const numbers = makeNumbers((to) => editor.step(to), () => editor.middle());

  function showSides(): void {
    if (!open) return;
    const { picture, facts: mesh } = studio;
    if (!warped || !picture || !mesh) return studio.showChosenSides();
    const original = { width: mesh.width, height: mesh.height, source: picture.bitmap };
    if (holding) warped.hide();
    else warped.show();
    if (holding) studio.showOwnSides(original, null);
    else if (split.checked) studio.showOwnSides(original, warped.layer);
    else studio.showOwnSides(warped.layer, null);
  }
  function hold(on: boolean): void {
    if (holding === on) return;
    holding = on;
    before.setAttribute("aria-pressed", String(on));
    showSides();
  }
  before.addEventListener("pointerdown", (e) => {
    before.setPointerCapture(e.pointerId);
    hold(true);
  });
  for (const end of ["pointerup", "pointercancel", "blur"]) before.addEventListener(end, () => hold(false));
  before.addEventListener("keydown", (e) => (e.key === " " || e.key === "Enter") && hold(true));
  before.addEventListener("keyup", () => hold(false));

  function update(): void {
    const edit = editor.current, some = editor.selection.size > 0, ready = editor.mesh !== null;
    level.set(String(editor.level));
    solver.set(editor.solver);
    border.checked = editor.border;
    border.disabled = editor.solver === "direct";
    kTools.forEach(({ id }, k) => tools[k]!.setAttribute("aria-pressed", String(editor.tool === id)));
    undo.disabled = !ready || !editor.history.canUndo;
    redo.disabled = !ready || !editor.history.canRedo;
    remove.disabled = !some || !edit;
    reset.disabled = !ready || editor.state.edits.length === 0;
    another.disabled = !ready || !edit;
    numbers.setEnabled(some);
    exports.setEnabled(ready);
    facts.textContent = !ready ? "There is no mesh yet."
      : some ? `${editor.selection.size === 1 ? "1 vertex is" : `${editor.selection.size} vertices are`} selected.`
      : edit ? `${held(edit, " and ") || "Nothing is held"} in this edit.`
      : "Click on a vertex of the mesh and drag it.";
    list.replaceChildren(...editor.state.edits.map((e, k) => h("li", {},
      h("button", { type: "button", class: "quiet", "aria-pressed": String(e.id === edit?.id), click: () => void editor.chooseEdit(e.id) },
        [`${k + 1}. Level ${e.level}`, held(e, ", ")].filter(Boolean).join(", ")),
      h("button", { type: "button", class: "quiet", "aria-label": `Delete edit ${k + 1}`, title: "Delete this edit", click: () => editor.deleteEdit(e.id) }, "✕"))));
    showFolds();
    view.invalidate();
  }
  function showFolds(): void {
    const turned = editor.folds?.turned, faces = turned?.[editor.level] ?? editor.turned.length, cells = editor.folds?.cells ?? 0;
    const elsewhere = (turned?.reduce((a, b) => a + b, 0) ?? faces) - faces;
    const parts = [faces > 0 && `${faces} ${faces === 1 ? "triangle is" : "triangles are"} turned over`, cells > 0 && `the image folds at ${cells} ${cells === 1 ? "pixel" : "pixels"}`].filter(Boolean);
    const lines = [...(parts.length > 0 ? [`${parts.join(", and ")}; shown in red.`] : []),
      ...(elsewhere > 0 ? [`on other levels ${elsewhere} ${elsewhere === 1 ? "triangle is" : "triangles are"} turned over, so this warp cannot be saved as a container.`] : []),
      ...editor.missed];
    folds.textContent = lines.map((line) => line.charAt(0).toUpperCase() + line.slice(1)).join(" ");
    folds.hidden = lines.length === 0;
  }

  editor.changed = update;
  editor.moved = (exact) => {
    warped?.moved();
    if (exact) update();
    else showFolds();
    // For tests and the curious: how long a step takes.
    view.element.dataset["step"] = editor.stepTime.toFixed(1);
    view.element.dataset["draw"] = (warped?.scriptTime ?? 0).toFixed(1);
  };
  editor.rested = () => {
    const { session } = studio;
    if (!session || !open) return;
    void warped?.rested();
    session.ask("warp.folds", null).then((found) => {
      if (session !== studio.session || editor.dragging) return;
      editor.folds = found;
      update();
    }, (error: unknown) => session === studio.session && studio.fail(error));
  };

  function begin(): void {
    const { session } = studio;
    stale = false;
    // Of a session that was replaced meanwhile, nothing is said.
    useMesh().catch((error: unknown) => session === studio.session && studio.fail(error));
  }
  async function useMesh(): Promise<void> {
    const { session, facts: mesh } = studio;
    pyramid.hidden = !mesh || mesh.levels.length > 1;
    level.setChoices((mesh?.levels ?? []).map(({ vertices }, k) => ({
      id: String(k), label: `${k}: ${vertices} vertices`, help: k === 0 ? "The finest: for detail." : "Coarser: for larger, smoother edits." })));
    await editor.open(session);
    if (session !== studio.session || !session || !studio.picture) return showSides();
    warped = new WarpedLayer(studio, editor, session);
    warped.paintWires = (gl, context, t) => overlay.wires()?.paint(gl, context, t);
    overlay.hasWires = () => warped?.hasWires === true && !holding;
    slow.hidden = warped.hasWebGl;
    showSides();
    await warped.open();
  }
  studio.on("mesh", () => {
    stale = true;
    warped?.close();
    warped = null;
    if (open) begin();
    else void editor.open(null);
  });
  window.addEventListener("keydown", (e) => {
    const typing = e.target instanceof HTMLInputElement && e.target.type !== "checkbox";
    if (open && !e.defaultPrevented && !typing && undoKey(editor, e)) e.preventDefault();
  });

  return {
    id: "warp",
    title: "Warp",
    element: h("div", { class: "panel warp" },
      h("p", { class: "intro" }, "Click on a vertex of the mesh to make a handle, and drag it. The image follows."),
      pyramid, level.element, solver.element,
      h("div", { class: "row", role: "group", "aria-label": "Tool" }, ...tools),
      h("label", { class: "check" }, border, "Pin the border"),
      h("div", { class: "row" }, undo, redo, remove, reset),
      facts, folds, slow,
      numbers.element,
      h("section", {}, h("div", { class: "field-head" }, h("h2", {}, "Edits"), another), list),
      h("div", { class: "row" }, before, h("label", { class: "check" }, split, "Before and after side by side")),
      exports.element,
      h("details", {}, h("summary", {}, "Keys, while the image has the focus"), keyList())),
    show() {
      open = true;
      removeOverlay = view.addOverlay(overlay);
      if (stale) begin();
      else showSides();
      update();
    },
    hide() {
      open = false;
      editor.endDrag();
      removeOverlay?.();
      removeOverlay = null;
      warped?.hide();
      studio.showChosenSides();
    },
  };
}

/** What an edit holds, in words; empty if nothing. */
function held({ moves, pins }: HandEdit, between: string): string {
  const count = (n: number, word: string): string => (n === 0 ? "" : `${n} ${word}${n === 1 ? "" : "s"}`);
  return [count(moves.size, "handle"), count(pins.size, "pin")].filter(Boolean).join(between);
}

function keyList(): HTMLElement {
  const keys: readonly [string, string][] = [
    ["Enter", "selects the vertex in the middle of the view"], ["Ctrl + arrows", "go to the next vertex"], ["Arrows", "move what is selected by 1 pixel, with Shift by 10"],
    ["Tab", "goes to the next handle"], ["[ and ]", "turn by 1 degree, with Shift by 15"], [", and .", "scale by 1 %, with Shift by 10 %"],
    ["P", "pins"], ["Delete", "takes handles and pins away"], ["Ctrl + A", "selects all handles"], ["Escape", "selects nothing"], ["Space + drag", "moves the view"],
  ];
  return h("ul", {}, ...keys.map(([key, text]) => h("li", {}, h("b", {}, key), ` ${text}`)));
}
