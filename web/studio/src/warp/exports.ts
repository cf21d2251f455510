// What can be taken along: the image, the edits, and maps for compositors.
import type { Studio } from "../contracts";
import { h } from "../ui/dom";
import { asDocument } from "./edits";
import type { WarpEditor } from "./editor";

export function makeExports(studio: Studio, editor: WarpEditor): { element: HTMLElement; setEnabled(enabled: boolean): void } {
  const stem = (): string => (studio.picture?.name ?? "image").replace(/\.[^.]*$/, "") || "image";
  const buttons: HTMLButtonElement[] = [];
  /** `make` returns the bytes; the button waits meanwhile. */
  const button = (label: string, title: string, ending: string, type: string, make: () => Promise<Uint8Array | string>): HTMLButtonElement => {
    const made = h("button", { type: "button", title, "data-export": ending }, label);
    made.addEventListener("click", () => {
      made.disabled = true;
      studio.tell(`Making ${stem()}${ending} …`);
      make()
        .then((bytes) => studio.save(stem() + ending, bytes, type), (error: unknown) => editor.fail(error))
        .finally(() => (made.disabled = false));
    });
    buttons.push(made);
    return made;
  };
  const session = () => {
    if (!studio.session) throw new Error("there is no mesh yet");
    return studio.session;
  };
  return {
    element: h(
      "section", { class: "warp-exports" },
      h("h2", {}, "Take it along"),
      h("div", { class: "row" },
        button("Image", "The warped image, as a PNG without loss", "-warped.png", "image/png", async () => session().ask("warp.png", null)),
        button("Edits", "The edits as a file, for imgmesh-warp --edits", "-edits.json", "application/json", async () =>
          JSON.stringify(asDocument(editor.state, editor.positions), null, 1) + "\n"),
        button("STMap", "For compositors: for each pixel of the warped image, the place in the image that it shows", "-stmap.exr", "image/x-exr", async () =>
          session().ask("warp.exr", { map: "stmap" })),
        button("Displacement", "For compositors: how far each pixel of the image moves", "-displacement.exr", "image/x-exr", async () =>
          session().ask("warp.exr", { map: "displacement" })),
        button("Container", "The meshes with their vertices moved, as a .glb", "-warped.glb", "model/gltf-binary", async () =>
          (await session().ask("warp.container", { name: `${stem()}-warped.glb` }))[0]!.bytes),
      ),
    ),
    setEnabled(enabled) {
      for (const b of buttons) b.disabled = !enabled;
    },
  };
}
