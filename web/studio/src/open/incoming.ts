// Files that come in: chosen, dropped anywhere on the page, or pasted.
import { h } from "../ui/dom";

/** Calls `open` with the files of one choice, drop or paste. */
export function addIncoming(input: HTMLInputElement, open: (files: File[]) => void): void {
  input.addEventListener("change", () => {
    const files = [...(input.files ?? [])];
    input.value = ""; // the same file may be chosen again
    if (files.length > 0) open(files);
  });

  const sign = h("div", { class: "drop-sign", hidden: true }, h("p", {}, "Drop an image or a container"));
  document.body.append(sign);
  const hasFiles = (e: DragEvent): boolean => e.dataTransfer?.types.includes("Files") ?? false;
  let depth = 0; // dragenter and dragleave come for every element on the way
  const show = (): void => {
    sign.hidden = depth <= 0;
  };
  window.addEventListener("dragenter", (e) => {
    if (!hasFiles(e)) return;
    depth += 1;
    show();
  });
  window.addEventListener("dragleave", (e) => {
    if (!hasFiles(e)) return;
    depth = Math.max(depth - 1, 0);
    show();
  });
  // A link that is dropped must not lead away from the page; text may be dropped into a field.
  const isField = (e: DragEvent): boolean => e.target instanceof HTMLInputElement;
  window.addEventListener("dragover", (e) => {
    if (!isField(e)) e.preventDefault();
    if (!hasFiles(e)) return;
    e.preventDefault();
    if (e.dataTransfer) e.dataTransfer.dropEffect = "copy";
  });
  window.addEventListener("drop", (e) => {
    depth = 0;
    show();
    if (!isField(e)) e.preventDefault();
    if (!hasFiles(e)) return;
    e.preventDefault();
    const files = [...(e.dataTransfer?.files ?? [])];
    if (files.length > 0) open(files);
  });
  window.addEventListener("paste", (e) => {
    const files = [...(e.clipboardData?.files ?? [])];
    if (files.length === 0) return;
    e.preventDefault();
    open(files);
  });
}
