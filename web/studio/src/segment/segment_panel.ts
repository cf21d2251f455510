// The Regions panel: one slider from fine to coarse, tools that join, split and cut out, and files.
import type { Panel, Studio } from "../contracts";
import { h } from "../ui/dom";
import { choiceField, sliderField } from "../ui/fields";
import type { Display } from "./editor";
import { kFileKinds, saveKind, type FileKind } from "./saving";
import { SegmentWork } from "./work";
import type { Tool } from "./overlay";

const kDisplays: readonly { id: Display; label: string }[] = [
  { id: "outlines", label: "Outlines" },
  { id: "colors", label: "Colours" },
  { id: "flat", label: "Mean colours" },
  { id: "contours", label: "Contour map" },
];

const kTools: readonly { id: Tool; label: string; help: string }[] = [
  { id: "select", label: "Select", help: "Click a region to select it. N selects the next one, J joins it with the neighbour most like it, S splits it." },
  { id: "join", label: "Join", help: "Draw across regions: they become one. A click joins a region with the neighbour most like it." },
  { id: "split", label: "Split", help: "Click a region to split it in two." },
  { id: "keep", label: "Keep", help: "Draw over the object that you want to cut out." },
  { id: "drop", label: "Drop", help: "Draw over what does not belong to the object." },
];

export function makeSegmentPanel(studio: Studio): Panel {
  const bar = h("progress", { max: 1, value: 0, "aria-label": "Finding regions", hidden: true });
  const work = new SegmentWork(
    studio,
    (fraction) => {
      bar.hidden = fraction === null;
      bar.value = fraction ?? 0;
    },
    () => refresh(),
  );

  const slider = sliderField({
    label: "Regions",
    help: "Regions that you join or split keep their outlines while you move this.",
    ends: ["Fine", "Coarse"],
    value: (place) => work.cells ** (1 - place),
    place: (value) => 1 - Math.log(Math.max(value, 1)) / Math.log(Math.max(work.cells, 2)),
    least: 1, most: 1, step: 1,
    round: Math.round,
    changed: (count, done) => work.cutTo(count, done),
  });
  const threshold = h("input", { type: "number", id: "segment-threshold", min: 0, step: "any", inputmode: "decimal" });
  threshold.addEventListener("change", () => {
    const value = Number(threshold.value);
    if (value > 0) work.cutBelow(value);
  });
  const display = choiceField("Show", kDisplays, (value) => work.show(value));

  const toolHelp = h("p", { class: "help", id: "segment-tool-help" }, kTools[0]!.help);
  const toolButtons = kTools.map(({ id, label, help }) => {
    const button = h("button", { type: "button", "aria-pressed": String(id === "select"), "aria-describedby": "segment-tool-help" }, label);
    button.addEventListener("click", () => {
      work.tool = id;
      for (const other of toolButtons) other.setAttribute("aria-pressed", String(other === button));
      toolHelp.textContent = help;
    });
    return button;
  });
  const button = (label: string, run: () => void, title: string): HTMLButtonElement => h("button", { type: "button", title, click: run }, label);
  const next = button("Next", () => work.selectNext(1), "Selects the next region (N)");
  const join = button("Join with most alike", () => work.joinSelected(), "Joins the selected region with its neighbour most like it (J)");
  const split = button("Split", () => work.splitSelected(), "Splits the selected region in two (S)");
  const undo = button("Undo", () => work.undo(), "Ctrl+Z"), redo = button("Redo", () => work.redo(), "Ctrl+Shift+Z");
  const reset = button("Start over", () => work.reset(), "Takes back all that was joined, split and marked");

  const quality = choiceField(
    "Contours",
    [
      { id: "default", label: "With texture", help: "" },
      { id: "fast", label: "Colours only (fast)", help: "Best for pixel art and other clean drawings." },
    ] as const,
    (value) => void work.start({ quality: value }),
  );
  const even = h("input", { type: "checkbox", id: "segment-even" });
  const superpixels = h("input", { type: "number", id: "segment-superpixels", min: 1, step: 1, value: 600, inputmode: "numeric", "aria-label": "Number of superpixels" });
  const evenChanged = (): void => {
    quality.element.hidden = even.checked;
    superpixels.disabled = !even.checked;
    void work.start({ superpixels: even.checked ? Math.max(1, Math.round(Number(superpixels.value)) || 600) : null });
  };
  even.addEventListener("change", evenChanged);
  superpixels.addEventListener("change", evenChanged);
  superpixels.disabled = true;

  let kind: FileKind = kFileKinds[0]!.id;
  const files = choiceField("Save", kFileKinds, (value) => (kind = value));
  const save = h("button", { type: "button", class: "main" }, "Save");
  save.addEventListener("click", () => {
    const { editor } = work;
    if (editor) saveKind(kind, studio, editor).catch((error: unknown) => studio.fail(error));
  });

  const body = h(
    "div", { class: "panel segment" },
    bar,
    h("form", { submit: (e: Event) => e.preventDefault() },
      slider.element,
      h("div", { class: "field-head" }, h("label", { for: "segment-threshold" }, "Threshold"), threshold),
      display.element,
      h("div", { class: "field" }, h("div", { class: "row tools", role: "group", "aria-label": "Tool" }, ...toolButtons), toolHelp),
      h("div", { class: "row" }, next, join, split),
      h("div", { class: "row" }, undo, redo, reset),
      quality.element,
      h("div", { class: "field-head" }, h("label", { class: "check", for: "segment-even" }, even, "Superpixels"), superpixels)),
    h("div", { class: "actions" }, files.element, save),
  );
  body.addEventListener("keydown", (event) => {
    if (event.target instanceof HTMLInputElement && event.target.type === "number") return;
    if ((event.ctrlKey || event.metaKey) && work.key(event)) event.preventDefault();
  });

  function refresh(): void {
    const { editor } = work;
    for (const control of [next, save, reset, ...toolButtons]) control.disabled = !editor;
    threshold.disabled = !editor;
    slider.setEnabled(editor !== null);
    join.disabled = split.disabled = editor?.selected === undefined || editor.selected === null;
    undo.disabled = !editor?.canUndo;
    redo.disabled = !editor?.canRedo;
    if (!editor) return;
    const { regions } = editor;
    slider.setRange(1, work.cells);
    slider.set(regions.count);
    if (document.activeElement !== threshold) threshold.value = String(Number(work.threshold.toPrecision(4)));
  }
  refresh();

  return {
    id: "segment",
    title: "Regions",
    element: body,
    show: () => work.open(),
    hide: () => work.close(),
  };
}
