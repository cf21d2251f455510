// The panels, one of which is open.
import type { Panel } from "../contracts";
import { h } from "./dom";

/** Fills `list` with a tab for each panel, and `host` with the panels. The first one is open. */
export function addTabs(list: HTMLElement, host: HTMLElement, panels: Panel[]): void {
  let open: Panel | null = null;
  const tabs = panels.map((panel) => {
    const tab = h("button", {
      type: "button", role: "tab", id: `tab-${panel.id}`, "aria-controls": `panel-${panel.id}`,
    }, panel.title);
    tab.addEventListener("click", () => choose(panel));
    panel.element.id = `panel-${panel.id}`;
    panel.element.setAttribute("role", "tabpanel");
    panel.element.setAttribute("aria-labelledby", tab.id);
    panel.element.hidden = true;
    list.append(tab);
    host.append(panel.element);
    return tab;
  });

  function choose(panel: Panel): void {
    if (panel === open) return;
    if (open) {
      open.element.hidden = true;
      open.hide();
    }
    open = panel;
    panels.forEach((other, k) => {
      tabs[k]!.setAttribute("aria-selected", String(other === panel));
      tabs[k]!.tabIndex = other === panel ? 0 : -1;
    });
    panel.element.hidden = false;
    panel.show();
  }

  list.addEventListener("keydown", (e) => {
    const at = panels.indexOf(open!), count = panels.length;
    const to: Record<string, number> = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: count - 1 };
    const next = to[e.key];
    if (next === undefined) return;
    e.preventDefault();
    const k = (next + count) % count;
    choose(panels[k]!);
    tabs[k]!.focus();
  });
  choose(panels[0]!);
}
