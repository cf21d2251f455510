// The status bar: what has happened, what is being done, and what went wrong.
import type { Messages } from "../app";
import { byId, h, icon } from "./dom";
import { kIcons } from "./icons";

/** Stages of a build as the engine calls them, in words for everybody. */
const kStages: Record<string, string> = {
  starting: "Building",
  opening: "Opening the container",
  collapse: "Building: merging vertices",
  refine: "Building: moving vertices to lower the error",
  map: "Building: finding a place for every pixel",
  done: "Building",
};

/** The engine's messages begin small and have no full stop. Names of files stay as they are. */
export function sentence(text: string): string {
  const word = text.split(" ", 1)[0]!;
  const begun = word.includes(".") ? text : text.charAt(0).toUpperCase() + text.slice(1);
  return /[.!?]$/.test(begun) ? begun : `${begun}.`;
}

export interface StatusBar extends Messages {
  /** Shows how far a build is; null when none runs. */
  progress(fraction: number | null, stage: string): void;
}

export function makeStatusBar(): StatusBar {
  const status = byId("status"), problem = byId("problem"), bar = byId<HTMLProgressElement>("progress");
  const clear = (): void => problem.replaceChildren();
  let said = ""; // screen readers hear a stage once, not every step of it
  let during = false; // a problem that came up during a build is still read when the build is done
  return {
    tell(text) {
      if (!during) clear();
      during = false;
      said = "";
      status.textContent = text;
    },
    fail(text) {
      during = !bar.hidden;
      status.textContent = "";
      const line = h("p", {}, sentence(text));
      problem.replaceChildren(
        line,
        h("button", { type: "button", class: "quiet", "aria-label": "Hide this message", click: clear }, icon(kIcons.close)),
      );
      return () => line.isConnected && clear();
    },
    progress(fraction, stage) {
      bar.hidden = fraction === null;
      if (fraction === null) return;
      bar.value = fraction;
      const text = `${kStages[stage] ?? `Building: ${stage}`}. Escape stops it.`;
      if (text === said) return;
      if (fraction === 0) clear();
      said = text;
      status.textContent = text;
    },
  };
}
