// Puts the page together.
import { App } from "./app";
import type { Panel } from "./contracts";
import { byId } from "./ui/dom";
import { addTabs } from "./ui/tabs";
import { CanvasView } from "./view/image_view";

const view = new CanvasView();
const status = byId("status");
const app = new App(view, {
  tell: (text) => (status.textContent = text),
  fail: (text) => (status.textContent = text),
});
byId("stage").append(view.element);
const panels: Panel[] = [];
if (panels.length > 0) addTabs(byId("tabs"), byId("panels"), panels);
app.tell("Ready.");
