// The bar under the view: what the two sides show, the wireframe, the level, and the zoom.
import type { App } from "../app";
import type { Layer, Overlay } from "../contracts";
import { kChoices, MeshLayers, type Choice } from "../layers/choices";
import type { CanvasView } from "../view/image_view";
import { h, icon } from "./dom";
import { kIcons } from "./icons";

/** A wireframe on the right of the split alone, or on both sides; only while the view shows these sides. */
function wireOver(view: CanvasView, wire: Overlay, onBoth: boolean, left: Layer | null, right: Layer | null): Overlay {
  return {
    draw(context, t) {
      if (!view.shows(left, right)) return;
      const from = onBoth ? 0 : view.splitAt();
      context.beginPath();
      context.rect(from, 0, t.width - from, t.height);
      context.clip();
      wire.draw?.(context, t);
    },
  };
}

export interface ViewBar {
  readonly element: HTMLElement;
  /** The level that is shown. */
  readonly level: number;
  /** Is called when another level is chosen. */
  onLevel: () => void;
  zoomed(): void;
}

export function makeViewBar(app: App, view: CanvasView): ViewBar {
  const select = (label: string, value: Choice): HTMLSelectElement => {
    const list = h("select", { "aria-label": label, title: label });
    for (const { id, label, title } of kChoices) list.append(h("option", { value: id, title }, label));
    list.value = value;
    return list;
  };
  const left = select("Left of the split", "picture"), right = select("Right of the split", "gouraud");
  const wire = h("select", { id: "wire", "aria-label": "Wireframe", title: "The edges of the triangles" },
    h("option", { value: "none" }, "No wireframe"), h("option", { value: "right" }, "Wireframe right"),
    h("option", { value: "both" }, "Wireframe both"));
  wire.value = "right";
  const level = h("select", { "aria-label": "Level of the mesh", title: "Level of the mesh", hidden: true });
  const zoom = h("output", { class: "zoom", title: "Size of an image pixel on the screen" });
  const button = (label: string, path: string, action: () => void): HTMLButtonElement =>
    h("button", { type: "button", class: "quiet", "aria-label": label, title: label, click: action }, icon(path));

  let picture: Layer | null = null;
  let layers: MeshLayers | null = null;
  let removeWire: (() => void) | null = null;
  let request = 0;
  let own = false; // whether a panel shows sides of its own

  const layerOf = async (choice: Choice): Promise<Layer | null> =>
    choice === "picture" || !layers ? picture : layers.layer(choice);

  /** Shows what is chosen once it is there; what was shown before stays until then. */
  async function apply(): Promise<void> {
    const mine = ++request;
    if (own) return;
    const [a, b] = await Promise.all([layerOf(left.value as Choice), layerOf(right.value as Choice)]);
    const where = wire.value;
    const edges = where !== "none" && layers ? await layers.wire() : null;
    if (mine !== request) return;
    removeWire?.();
    removeWire = edges ? view.addOverlay(wireOver(view, edges, where === "both", a, b), true) : null;
    view.setSides(a, b);
  }
  const show = (): void => {
    apply().catch((error: unknown) => app.session && app.fail(error));
  };

  const bar: ViewBar = {
    element: h(
      "div", { class: "view-bar", role: "group", "aria-label": "View" },
      h("div", { class: "sides" }, left, button("Swap the sides", kIcons.swap, swap), right),
      h("div", { class: "more" }, wire, level),
      h("div", { class: "zooms" }, button("Zoom out", kIcons.minus, () => view.zoom(1 / 1.25)), zoom,
        button("Zoom in", kIcons.plus, () => view.zoom(1.25)), button("Show all of the image", kIcons.fit, () => view.fit())),
    ),
    get level() {
      return Number(level.value || 0);
    },
    onLevel: () => {},
    zoomed() {
      const percent = 100 * view.transform.scale * view.transform.ratio;
      const text = `${percent < 10 ? percent.toFixed(1) : Math.round(percent)} %`;
      if (zoom.value !== text) zoom.value = text;
    },
  };

  /** What chooses the sides has nothing to say while a panel does. */
  function setOwn(on: boolean): void {
    own = on;
    bar.element.classList.toggle("own", on);
  }
  function swap(): void {
    [left.value, right.value] = [right.value, left.value];
    show();
  }
  function useMesh(): void {
    const old = layers;
    layers = app.session && app.facts ? new MeshLayers(app, app.session, bar.level) : null;
    // The old layers are shown until the new ones are there.
    apply().then(() => old?.close(), (error: unknown) => app.session && app.fail(error));
  }

  left.addEventListener("change", show);
  right.addEventListener("change", show);
  wire.addEventListener("change", show);
  level.addEventListener("change", () => {
    useMesh();
    bar.onLevel();
  });
  app.on("picture", () => {
    const shown = app.picture;
    picture = shown && { width: shown.pixels.width, height: shown.pixels.height, source: shown.bitmap };
    if (!shown) return;
    view.setSides(picture, picture);
    view.fit();
    view.describe(`${shown.name}, ${shown.pixels.width} by ${shown.pixels.height} pixels`);
  });
  app.on("mesh", () => {
    const count = app.facts?.levels.length ?? 1, was = bar.level;
    level.replaceChildren();
    for (let k = 0; k < count; ++k) level.append(h("option", { value: k }, k === 0 ? "Level 0, finest" : `Level ${k}`));
    level.value = String(was < count ? was : 0);
    level.hidden = count < 2;
    useMesh();
  });
  app.showOwnSides = (a, b) => {
    ++request;
    setOwn(true);
    removeWire?.();
    removeWire = null;
    view.setSides(a, b);
  };
  app.showChosenSides = () => {
    setOwn(false);
    show();
  };
  return bar;
}
