// Puts the page together.
import { byId } from "../../studio/src/ui/dom";
import { sentence } from "../../studio/src/ui/messages";
import { goTo, type Place, placeOf, readPlace, writePlace, zoomOf } from "./place";
import { setAt, setOfDrop, setOfFiles, type SetSource } from "./set_source";
import { TileView } from "./tile_view";

const wire = byId<HTMLButtonElement>("wire"), tiles = byId<HTMLButtonElement>("tiles");
const problem = byId("problem"), address = byId<HTMLInputElement>("address");

/** The name of the set, and whether it is there: until then, links are not changed. */
let source: SetSource | null = null;
let size: { width: number; height: number } | null = null;

function fail(text: string): void {
  const line = document.createElement("p");
  line.textContent = sentence(text);
  problem.replaceChildren(line);
}

function makeView(): TileView | null {
  try {
    return new TileView(byId("stage"), { opened, failed }, drawn);
  } catch {
    fail("This page needs WebGL 2, which the browser does not have or has switched off");
    return null;
  }
}

function opened(found: { width: number; height: number }): void {
  size = found;
  const text = `${source!.name}, ${size.width} × ${size.height} pixels`;
  byId("file-name").textContent = text;
  document.title = `${source!.name} - imgmesh tiles`;
  view!.describe(text);
  show(readPlace(location.hash));
}

function failed(text: string, broken: boolean): void {
  // The page beside no set is not broken: it waits for one.
  if (!broken && source!.url === kBeside.url && !kNamed) return say("Drop the folder of a tile set here, or open one by its address.");
  if (!broken) say("");
  fail(text);
}

/** The line at the bottom. Screen readers do not hear it: it changes with every move. */
function say(text: string): void {
  const status = byId("status");
  if (status.textContent !== text) status.textContent = text;
}

const count = (n: number, what: string): string => `${n.toLocaleString("en")} ${what}${n === 1 ? "" : "s"}`;

function drawn(): void {
  const zoom = zoomOf(view!.transform), shown = view!.scene.shown();
  byId("zoom").textContent = size ? `${zoom < 10 ? zoom.toPrecision(2) : Math.round(zoom)} %` : "";
  byId("stage").setAttribute("aria-busy", String(view!.scene.loading));
  if (!size) return;
  const levels = [...new Set(shown.map(({ level }) => level))].sort((a, b) => a - b);
  const triangles = shown.reduce((sum, tile) => sum + tile.triangles, 0);
  say(`Level ${levels.join(" and ") || "-"} · ${count(shown.length, "tile")} on the screen, ${view!.scene.loadedTiles} in memory · ${count(triangles, "triangle")}`);
  keepPlace();
}

let saving = 0;
/** Writes the view into the address, at most five times a second, as browsers refuse more. */
function keepPlace(): void {
  saving ||= window.setTimeout(() => {
    saving = 0;
    const hash = writePlace({ at: placeOf(view!.transform), wire: view!.scene.wire, tiles: view!.frames });
    if (hash !== location.hash) history.replaceState(null, "", hash || location.pathname + location.search);
  }, 200);
}

function show(place: Place): void {
  goTo(view!.transform, place.at);
  setShown(place);
}

function setShown({ wire: lines, tiles: frames }: Pick<Place, "wire" | "tiles">): void {
  view!.scene.wire = lines;
  view!.frames = frames;
  wire.setAttribute("aria-pressed", String(lines));
  tiles.setAttribute("aria-pressed", String(frames));
  view!.invalidate();
}

function open(next: SetSource): void {
  source = next;
  size = null;
  problem.replaceChildren();
  say(`Opening ${next.name} …`);
  view!.scene.open(next);
}

/** A set of this computer has no address: the page's own would show another. */
function openFolder(next: SetSource | null): void {
  if (!next) return fail("Drop the folder that tileset.json is in");
  history.replaceState(null, "", location.pathname);
  open(next);
}

const kBeside = setAt("tileset.json");
const kNamed = new URLSearchParams(location.search).get("set");

const view = makeView();
if (view) {
  const by = (id: string, action: () => void): void => byId(id).addEventListener("click", action);
  by("wire", () => setShown({ wire: !view.scene.wire, tiles: view.frames }));
  by("tiles", () => setShown({ wire: view.scene.wire, tiles: !view.frames }));
  by("zoom-in", () => change(() => view.transform.zoom(1.25)));
  by("zoom-out", () => change(() => view.transform.zoom(1 / 1.25)));
  by("fit", () => change(() => view.transform.fit()));
  const change = (work: () => void): void => {
    work();
    view.invalidate();
  };
  view.onPointer((pixel) => {
    byId("pixel").textContent = pixel && size ? `${Math.round(pixel.x)}, ${Math.round(pixel.y)}` : "";
  });
  window.addEventListener("hashchange", () => show(readPlace(location.hash)));
  window.addEventListener("dragover", (e) => e.preventDefault());
  window.addEventListener("drop", (e) => {
    e.preventDefault();
    if (e.dataTransfer) openFolder(setOfDrop(e.dataTransfer.items));
  });
  byId<HTMLInputElement>("folder").addEventListener("change", (e) => {
    const files = [...((e.target as HTMLInputElement).files ?? [])];
    if (files.length > 0) openFolder(setOfFiles(files));
  });
  address.value = kNamed ?? "";
  open(kNamed ? setAt(kNamed) : kBeside);
}
