// What is known of a mesh, as it is.
import type { App } from "../app";
import type { Figures } from "../worker/view";
import { h } from "../ui/dom";

/** Every figure with its one line of explanation. */
const kRows = [
  { id: "vertices", label: "Vertices", help: "corners of the triangles" },
  { id: "faces", label: "Triangles", help: "faces of the mesh" },
  { id: "bytes", label: "File", help: "size of the container (.glb) with mesh and pixel map, as the page saves it" },
  { id: "rms", label: "Error", help: "RMS difference of the reconstruction in L*u*v*, the unit of seen colour; 1 is hardly visible" },
  { id: "psnr", label: "PSNR", help: "the same as a ratio in decibels; more is better, and 40 dB is hardly visible" },
  { id: "folds", label: "Folds", help: "triangles that are turned over; always 0 after a build" },
  { id: "time", label: "Time", help: "of the build, in this browser" },
] as const;
type RowId = (typeof kRows)[number]["id"];

/** The container of an image up to this size is saved at once to see how large it is. */
const kQuickPixels = 5e6;

export function bytesText(bytes: number): string {
  if (bytes < 1000) return `${bytes} bytes`;
  const [unit, name] = bytes < 1e6 ? [1e3, "kB"] : [1e6, "MB"];
  const value = bytes / unit;
  return `${value < 10 ? value.toFixed(2) : value < 100 ? value.toFixed(1) : Math.round(value)} ${name}`;
}

const count = (n: number): string => n.toLocaleString("en").replaceAll(",", "\u2009");

/** The list of figures. show() asks the session for them, so they come a moment after the mesh. */
export function makeFigures(app: App): { element: HTMLElement; show(level: number): Promise<void> } {
  const values = new Map<RowId, HTMLElement>();
  const list = h("dl", { class: "figures" });
  for (const { id, label, help } of kRows) {
    const value = h("dd", { id: `figure-${id}` }, "–");
    values.set(id, value);
    list.append(h("div", { title: help }, h("dt", {}, label), value));
  }
  const explanations = h("ul", {}, ...kRows.map(({ label, help }) => h("li", {}, h("b", {}, label), `: ${help}.`)));
  const set = (id: RowId, text: string): void => {
    values.get(id)!.textContent = text;
  };
  let request = 0;

  async function show(level: number): Promise<void> {
    const mine = ++request;
    const { session, facts } = app;
    const of = facts?.levels[level];
    for (const { id } of kRows) set(id, "–");
    if (!session || !of) return;
    set("vertices", count(of.vertices));
    set("faces", count(of.faces));
    if (of.rms !== undefined) set("rms", of.rms.toFixed(2));
    if (app.seconds !== null) set("time", `${app.seconds.toFixed(app.seconds < 10 ? 2 : 1)} s`);
    const figures: Figures = await session.ask("view.figures", { level });
    if (mine !== request) return;
    void showBytes();
    set("folds", count(figures.quality.flippedFaces + figures.quality.flippedPixelTriangles));
    if (!figures.comparison) return;
    set("rms", figures.comparison.rmsLuv.toFixed(2));
    const { psnr } = figures.comparison;
    set("psnr", Number.isFinite(psnr) ? `${psnr.toFixed(2)} dB` : "no difference");
  }

  /** Saves the container to see its size, at once where that is quick. */
  async function showBytes(): Promise<void> {
    const { session, facts } = app, value = values.get("bytes")!;
    if (!session || !facts) return;
    if (app.bytes !== null) return set("bytes", bytesText(app.bytes));
    const measure = async (): Promise<void> => {
      set("bytes", "…");
      const files = await session.ask("export.container", { options: { name: "image.glb", layers: "compact" } });
      if (app.session === session) set("bytes", bytesText(files.reduce((sum, { bytes }) => sum + bytes.length, 0)));
    };
    const guarded = (): void => void measure().catch((error: unknown) => app.session === session && app.fail(error));
    if (facts.width * facts.height <= kQuickPixels) return guarded();
    value.replaceChildren(h("button", { type: "button", class: "small", title: "Takes a few seconds", click: guarded }, "measure"));
  }
  return {
    element: h("section", { "aria-label": "Figures" }, list,
      h("details", {}, h("summary", {}, "What these numbers mean"), explanations)),
    show,
  };
}
