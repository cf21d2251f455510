// Puts the page together.
import { App } from "./app";
import { makeExportPanel } from "./export/export_panel";
import type { Panel, Picture } from "./contracts";
import { makeMeshPanel } from "./mesh/mesh_panel";
import { decodePicture } from "./open/decode";
import { addIncoming } from "./open/incoming";
import { makeSegmentPanel } from "./segment/segment_panel";
import { loadEngine } from "./session";
import { byId } from "./ui/dom";
import { makeStatusBar } from "./ui/messages";
import { addTabs } from "./ui/tabs";
import { makeViewBar } from "./ui/view_bar";
import { CanvasView } from "./view/image_view";
import { makeWarpPanel } from "./warp/warp_panel";

const status = makeStatusBar();
const view = new CanvasView(() => bar.zoomed());
const app = new App(view, status);
const bar = makeViewBar(app, view);
const meshPanel = makeMeshPanel(app, status.progress);
bar.onLevel = () => meshPanel.showLevel(bar.level);
const panels: Panel[] = [
  meshPanel,
  makeWarpPanel(app, (levels) => meshPanel.buildLevels(levels)),
  makeSegmentPanel(app),
  makeExportPanel(app),
];

byId("stage").append(view.element);
byId("view-bar").append(bar.element);
addTabs(byId("tabs"), byId("panels"), panels);
app.on("picture", () => {
  const { picture } = app;
  byId("file-name").textContent = picture ? `${picture.name}, ${picture.pixels.width} × ${picture.pixels.height}` : "";
});

let opening = 0;
const isContainer = ({ name }: File): boolean => /\.(glb|gltf)$/i.test(name);
const isSidecar = ({ name }: File): boolean => /\.(bin|exr|imgmap)$/i.test(name);

/** Opens what came in, and meshes an image. What was open stays if it cannot be read. */
async function open(files: File[]): Promise<void> {
  const mine = ++opening;
  try {
    const container = files.find(isContainer);
    const others = files.filter((file) => !isContainer(file) && !isSidecar(file));
    const images = others.filter(({ type }) => type.startsWith("image/"));
    if (images.length > 1) throw new Error(`${images.map(({ name }) => name).join(" and ")} came in together: choose one image at a time.`);
    const image = images[0] ?? others[0];
    app.tell(`Reading ${(container ?? image ?? files[0]!).name} …`);
    if (!container && !image)
      throw new Error(`${files[0]!.name} belongs to a container: choose it together with its .gltf file.`);
    const picture = image ? await decodePicture(image, image.name) : null;
    if (mine !== opening) return picture?.bitmap.close(); // another file came in the meantime
    if (container) return await openContainer(container, files.filter((file) => file !== image), picture);
    app.setPicture(picture!);
    await meshPanel.build();
  } catch (error) {
    if (mine === opening) app.fail(error);
  }
}

async function openContainer(container: File, files: File[], original: Picture | null): Promise<void> {
  const named = await Promise.all(files.map(async (file) => ({ name: file.name, bytes: new Uint8Array(await file.arrayBuffer()) })));
  status.progress(0, "opening");
  if (await app.openContainer(container.name, named, original))
    app.tell(`Opened ${container.name}: ${app.facts!.levels[0]!.vertices} vertices.`);
}
addIncoming(byId<HTMLInputElement>("open"), (files) => void open(files));

window.addEventListener("keydown", (e) => {
  if (e.key === "Escape" && !e.defaultPrevented && app.stop()) app.tell("Stopped.");
});

/** The picture that is there from the start. */
async function openSample(): Promise<void> {
  const response = await fetch(new URL("../sample.jpg", import.meta.url));
  if (!response.ok) throw new Error("The first image could not be loaded; open one of your own.");
  const picture = await decodePicture(await response.blob(), "sample.jpg");
  if (opening > 0) return picture.bitmap.close();
  app.setPicture(picture);
  // The engine may take a while on a slow connection: the image is seen first.
  await meshPanel.build();
}
loadEngine().catch((error: unknown) => app.fail(error));
openSample().catch((error: unknown) => app.fail(error));
