// Controls that several panels use.
import { h } from "./dom";

let next = 0;

export interface SliderOptions {
  label: string;
  help?: string;
  /** Ends of the slider in words. */
  ends?: readonly [string, string];
  /** From the slider's place, 0 to 1, to the value, and back. */
  value(place: number): number;
  place(value: number): number;
  /** Of the number beside it. */
  least: number;
  most: number;
  step: number | "any";
  /** Rounds what comes from the slider. */
  round(value: number): number;
  /** Is called while the slider moves, and with done when the value has been chosen. */
  changed(value: number, done: boolean): void;
}

export interface SliderField {
  readonly element: HTMLElement;
  readonly note: HTMLElement;
  set(value: number): void;
  setRange(least: number, most: number): void;
  setEnabled(enabled: boolean): void;
}

/** A slider with a number beside it. */
export function sliderField(options: SliderOptions): SliderField {
  const id = `field-${next++}`;
  const slider = h("input", {
    type: "range", min: 0, max: 1, step: "any", id: `${id}-slider`, "aria-labelledby": `${id}-label`,
    "aria-describedby": options.help ? `${id}-help` : null,
  });
  const number = h("input", { type: "number", id, min: options.least, max: options.most, step: options.step, inputmode: "decimal" });
  const note = h("span", { class: "note" });
  const text = (value: number): string => String(Number(value.toPrecision(6)));

  const show = (value: number): void => {
    slider.value = String(options.place(value));
    slider.setAttribute("aria-valuetext", text(value));
  };
  const fromSlider = (done: boolean) => () => {
    const value = options.round(options.value(Number(slider.value)));
    number.value = text(value);
    slider.setAttribute("aria-valuetext", number.value);
    options.changed(value, done);
  };
  slider.addEventListener("input", fromSlider(false));
  slider.addEventListener("change", fromSlider(true));
  slider.addEventListener("keydown", (e) => {
    // The browser's own steps are those of whole numbers, or none.
    const steps: Record<string, number> = { ArrowRight: 0.02, ArrowUp: 0.02, ArrowLeft: -0.02, ArrowDown: -0.02, PageUp: 0.1, PageDown: -0.1 };
    const step = steps[e.key];
    if (step === undefined) return;
    e.preventDefault();
    slider.value = String(Number(slider.value) + step);
    fromSlider(true)();
  });
  let last = ""; // what the field goes back to where no number is typed
  number.addEventListener("focus", () => (last = number.value));
  number.addEventListener("change", () => {
    const value = Number(number.value);
    if (number.value === "" || !Number.isFinite(value)) return void (number.value = last);
    const kept = Math.min(Math.max(value, Number(number.min)), Number(number.max));
    last = number.value = text(kept);
    show(kept);
    options.changed(kept, true);
  });

  return {
    element: h(
      "div", { class: "field" },
      h("div", { class: "field-head" }, h("label", { for: id, id: `${id}-label` }, options.label), note, number),
      slider,
      options.ends && h("div", { class: "ends", "aria-hidden": "true" }, h("span", {}, options.ends[0]), h("span", {}, options.ends[1])),
      options.help ? h("p", { class: "help", id: `${id}-help` }, options.help) : null,
    ),
    note,
    set(value) {
      number.value = text(value);
      show(value);
    },
    setRange(least, most) {
      number.min = String(least);
      number.max = String(most);
    },
    setEnabled(enabled) {
      slider.disabled = number.disabled = !enabled;
    },
  };
}

export interface Choice<T extends string> {
  id: T;
  label: string;
  help?: string;
}

/** A list of choices under a label; `help` is shown below it. */
export function choiceField<T extends string>(
  label: string,
  choices: readonly Choice<T>[],
  changed: (value: T) => void,
): { element: HTMLElement; set(value: T): void; setChoices(choices: readonly Choice<T>[]): void } {
  const id = `field-${next++}`;
  const list = h("select", { id, "aria-describedby": `${id}-help` });
  const fill = (): void => list.replaceChildren(...choices.map((choice) => h("option", { value: choice.id }, choice.label)));
  fill();
  const help = h("p", { class: "help", id: `${id}-help` });
  const explain = (): void => {
    help.textContent = choices.find((choice) => choice.id === list.value)?.help ?? "";
  };
  list.addEventListener("change", () => {
    explain();
    changed(list.value as T);
  });
  explain();
  return {
    element: h("div", { class: "field" }, h("div", { class: "field-head" }, h("label", { for: id }, label), list), help),
    set(value) {
      list.value = value;
      explain();
    },
    setChoices(others) {
      choices = others;
      fill();
      explain();
    },
  };
}
