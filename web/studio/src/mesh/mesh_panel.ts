// The panel that builds the mesh and shows its figures.
import type { App } from "../app";
import type { Panel } from "../contracts";
import { choiceField, sliderField } from "../ui/fields";
import { h } from "../ui/dom";
import { sentence } from "../ui/messages";
import { makeFigures } from "./figures";
import {
  hasAlpha, kAlphaUses, kLeastVertices, kPresets, mostVertices, parametersOf, usualVertices, type AlphaUse, type PresetName, type Settings,
} from "./settings";

/** Images up to this size are meshed again whenever a setting changes. */
const kQuickPixels = 3e6;
/** How long a setting must rest before it is used, in ms. */
const kPause = 200;
const kMostShape = 2;
const kLeastSmoothness = 1, kMostSmoothness = 1000;

export interface MeshPanel extends Panel {
  /** Builds with the settings as they are. */
  build(): Promise<void>;
  /** Builds a pyramid of so many meshes. */
  buildLevels(count: number): void;
  /** Shows the figures of another level. */
  showLevel(level: number): void;
}

/** `progress` is shown while a build runs; null when it ends. */
export function makeMeshPanel(app: App, progress: (fraction: number | null, stage: string) => void): MeshPanel {
  const settings: Settings = { preset: "default", vertices: null, shape: null, smoothness: null, levels: 1, alpha: "auto" };
  const figures = makeFigures(app);
  const warnings = h("ul", { class: "warnings", hidden: true });
  const live = h("input", { type: "checkbox", checked: true });
  live.checked = true;
  let level = 0;

  // Keys that are held down change a setting many times a second.
  let soon = 0;
  const changed = (done = true): void => {
    window.clearTimeout(soon);
    if (done && live.checked && app.picture) soon = window.setTimeout(() => void build(), kPause);
    else main.classList.toggle("waiting", done);
  };

  const vertices = sliderField({
    label: "Vertices",
    help: "Corners of triangles. More of them follow the image more closely, and take more bytes.",
    ...logarithmic(() => kLeastVertices, () => (app.picture ? mostVertices(app.picture.pixels) : 1e6)),
    least: kLeastVertices, most: 1e9, step: 1,
    round: (value) => Math.round(Number(value.toPrecision(3))),
    changed(value, done) {
      settings.vertices = value;
      showPercent();
      changed(done);
    },
  });
  const shape = sliderField({
    label: "Triangle shape",
    help: "Sliver triangles follow edges; regular ones are better to deform and to simulate with.",
    ends: ["lowest error", "regular"],
    value: (place) => kMostShape * place * place,
    place: (value) => Math.sqrt(value / kMostShape),
    least: 0, most: 1000, step: "any",
    round: (value) => Math.round(value * 100) / 100,
    changed(value, done) {
      settings.shape = value;
      changed(done);
    },
  });
  const smoothness = sliderField({
    label: "Map smoothness",
    help: "How freely pixels move on the mesh to find their own colour. A smooth map takes fewer bytes.",
    ends: ["true to colour", "smooth"],
    ...logarithmic(() => kLeastSmoothness, () => kMostSmoothness),
    least: 0.001, most: 1e6, step: "any",
    round: (value) => Number(value.toPrecision(2)),
    changed(value, done) {
      settings.smoothness = value;
      changed(done);
    },
  });
  const preset = choiceField("Goal", kPresets, (value: PresetName) => {
    settings.preset = value;
    settings.shape = settings.smoothness = null;
    showPreset();
    changed();
  });
  const alpha = choiceField<AlphaUse>("Transparency", kAlphaUses, (value) => {
    settings.alpha = value;
    changed();
  });
  const levels = choiceField("Levels", [1, 2, 3, 4].map((n) => ({
    id: String(n),
    label: n === 1 ? "One mesh" : `${n} meshes`,
    help: n === 1 ? "Coarser meshes above it make large, smooth changes easy when you warp." : "Each has a quarter of the triangles of the one before, for warping.",
  })), (value) => {
    settings.levels = Number(value);
    changed();
  });

  const main = h("button", { type: "button", class: "main", id: "build", click: () => (app.busy ? stop() : void build()) }, "Build mesh");

  function showPreset(): void {
    const { shape: usual, smoothness: smooth } = kPresets.find(({ id }) => id === settings.preset)!;
    shape.set(usual ?? 0);
    shape.setEnabled(usual !== null);
    smoothness.set(smooth);
  }
  function showPercent(): void {
    const { picture } = app;
    if (!picture) return;
    const share = (100 * (settings.vertices ?? app.facts?.levels[0]?.vertices ?? usualVertices(picture.pixels))) / (picture.pixels.width * picture.pixels.height);
    vertices.note.textContent = `${share < 0.1 ? share.toPrecision(1) : share.toFixed(share < 10 ? 1 : 0)} % of the pixels`;
  }
  function stop(): void {
    if (app.stop()) app.tell("Stopped. " + (app.facts ? "The mesh from before is still there." : "There is no mesh yet."));
  }

  async function build(): Promise<void> {
    window.clearTimeout(soon);
    main.classList.remove("waiting");
    if (!app.picture) return app.tell("Open an image first.");
    progress(0, "starting");
    try {
      const done = await app.build(parametersOf(settings), app.picture && { alpha: settings.alpha }, (fraction, stage) => progress(fraction, stage));
      if (done) app.tell(`Meshed in ${app.seconds!.toFixed(1)} s: ${app.facts!.levels[0]!.vertices} vertices.`);
    } catch (error) {
      app.fail(error instanceof Error ? new Error(inWordsOfThePage(error.message)) : error);
    }
  }

  app.on("build", () => {
    main.textContent = app.busy ? "Stop" : "Build mesh";
    main.classList.toggle("stop", app.busy);
    if (!app.busy) progress(null, "");
  });
  app.on("picture", () => {
    const { picture } = app;
    if (!picture) return;
    settings.vertices = null;
    settings.alpha = "auto";
    alpha.set("auto");
    alpha.element.hidden = !hasAlpha(picture.pixels);
    vertices.setRange(kLeastVertices, Math.max(kLeastVertices, picture.pixels.width * picture.pixels.height));
    vertices.set(usualVertices(picture.pixels));
    showPercent();
    live.checked = picture.pixels.width * picture.pixels.height <= kQuickPixels;
  });
  const showFigures = (): void => {
    figures.show(level).catch((error: unknown) => app.session && app.fail(error));
  };
  app.on("mesh", () => {
    level = Math.min(level, (app.facts?.levels.length ?? 1) - 1);
    const lines = (app.facts?.warnings ?? []).map(inWordsOfThePage);
    warnings.replaceChildren(...lines.map((line) => h("li", {}, line)));
    warnings.hidden = lines.length === 0;
    // Where nothing is said, 1 % of the pixels inside a mask are taken.
    if (settings.vertices === null && app.facts) vertices.set(app.facts.levels[0]!.vertices);
    showPercent();
    showFigures();
  });
  showPreset();

  return {
    id: "mesh",
    title: "Mesh",
    element: h(
      "div", { class: "panel" },
      h("p", { class: "intro" }, "A small mesh of triangles takes the place of the pixels, and follows what is in the image."),
      figures.element, warnings,
      h("form", { submit: (e: Event) => e.preventDefault() }, vertices.element, preset.element, shape.element, smoothness.element, alpha.element, levels.element,
        h("label", { class: "check" }, live, "Build whenever a setting changes")),
      h("div", { class: "actions" }, main),
    ),
    show: () => {},
    hide: () => {},
    build,
    buildLevels(count) {
      settings.levels = count;
      levels.set(String(count));
      void build();
    },
    showLevel(index) {
      level = index;
      showFigures();
    },
  };
}

/** The engine names settings as its callers in JavaScript write them. */
function inWordsOfThePage(line: string): string {
  const label = (id: string): string => kAlphaUses.find((use) => use.id === id)?.label ?? id;
  return sentence(line.replace(/\balpha: "(\w+)"/g, (_, id: string) => `Transparency “${label(id)}”`));
}

/** A slider whose steps are factors. */
function logarithmic(least: () => number, most: () => number) {
  return {
    value: (place: number): number => least() * Math.pow(most() / least(), place),
    place: (value: number): number => Math.log(value / least()) / Math.log(most() / least()),
  };
}
