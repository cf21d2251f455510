// Moving, turning and scaling by numbers.
import type { Point } from "../contracts";
import { h } from "../ui/dom";
import { kLeastScale, kMostMove, kMostScale, kMostTurn } from "./edits";
import type { Transformation } from "./editor";
import { movedBy, scaledBy, turnedBy } from "./gizmo";

interface NumberField {
  readonly element: HTMLElement;
  readonly input: HTMLInputElement;
  /** What is in the field; `usual` if nothing is. */
  readonly value: number;
  /** What is wrong with it, in words; null if nothing is. */
  readonly problem: string | null;
}

/** `step` does what the numbers say, about the point of `middle`. */
export function makeNumbers(step: (to: Transformation) => void, middle: () => Point): { element: HTMLElement; setEnabled(enabled: boolean): void } {
  const right = numberField("Right", 0, "px", -kMostMove, kMostMove), down = numberField("Down", 0, "px", -kMostMove, kMostMove);
  const turn = numberField("Turn left", 0, "°", -kMostTurn, kMostTurn), scale = numberField("Scale", 100, "%", 100 * kLeastScale, 100 * kMostScale);
  const fields = [right, down, turn, scale], problems = h("p", { class: "warp-problem", role: "alert", hidden: true });

  /** Says what is wrong. Returns the first field that is. */
  function check(): NumberField | undefined {
    for (const { input, problem } of fields) input.setAttribute("aria-invalid", String(problem !== null));
    const lines = fields.flatMap(({ problem }) => problem ?? []).join(" ");
    if (problems.textContent !== lines) problems.textContent = lines;
    problems.hidden = lines === "";
    return fields.find(({ problem }) => problem !== null);
  }
  for (const { input } of fields) input.addEventListener("change", check);
  // A line goes as soon as it is wrong, but does not come while one types.
  for (const { input } of fields) input.addEventListener("input", () => !problems.hidden && check());

  const apply = h("button", { type: "button", title: "Moves, turns and scales what is selected by these numbers" }, "Apply");
  apply.addEventListener("click", () => {
    const wrong = check();
    if (wrong) return wrong.input.focus();
    const about = middle(), turned = turnedBy(turn.value, about), scaled = scaledBy(scale.value / 100, about), moved = movedBy(right.value, down.value);
    step((x, y) => moved(...turned(...scaled(x, y))));
  });
  return {
    element: h("details", {}, h("summary", {}, "By numbers"),
      h("div", { class: "warp-numbers" }, ...fields.map(({ element }) => element)), problems, apply),
    setEnabled(enabled) {
      apply.disabled = !enabled;
    },
  };
}

function numberField(label: string, usual: number, unit: string, min: number, max: number): NumberField {
  const input = h("input", { type: "number", step: "any", min, max, value: usual, "aria-label": label });
  const words = (value: number): string => value.toLocaleString("en").replace("-", "−");
  return {
    element: h("label", { class: "warp-number" }, label, input, unit),
    input,
    get value() {
      return Number.isFinite(input.valueAsNumber) ? input.valueAsNumber : usual;
    },
    get problem() {
      return input.validity.valid ? null : `“${label}” takes numbers from ${words(min)} to ${words(max)}.`;
    },
  };
}
