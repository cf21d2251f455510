// The panel that saves files.
import type { NamedFile, Pixels } from "imgmesh.wasm";
import type { Panel, Studio } from "../contracts";
import { bytesText } from "../mesh/figures";
import { h } from "../ui/dom";
import { choiceField } from "../ui/fields";
import { kFormats, type ExportSettings, type Format, type Shading } from "./formats";

/** A poster larger than this is a mistake of typing. */
const kMostWidth = 100000;
const kJpegQuality = 0.95;

const kTypes: Record<string, string> = {
  glb: "model/gltf-binary", svg: "image/svg+xml", json: "application/json", png: "image/png", jpg: "image/jpeg",
  obj: "model/obj", mtl: "model/mtl",
};

/** The name of a file without its ending, and without what a file system may refuse. */
export function plainName(name: string): string {
  const stem = name.replace(/\.[^.]*$/, "").replace(/[\u0000-\u001f\u007f/\\:*?"<>|]/g, "_").trim();
  return stem.replace(/^\.+/, "").slice(0, 200) || "image";
}

/** The colours, also where the image is transparent: a drawing of it would mix them with black there. */
async function jpegOf({ width, height, data }: Pixels): Promise<Uint8Array> {
  const canvas = h("canvas", { width, height }), opaque = new Uint8ClampedArray(data);
  for (let i = 3; i < opaque.length; i += 4) opaque[i] = 255;
  canvas.getContext("2d")!.putImageData(new ImageData(opaque, width, height), 0, 0);
  const blob = await new Promise<Blob | null>((resolve) => canvas.toBlob(resolve, "image/jpeg", kJpegQuality));
  if (!blob) throw new Error("This browser cannot make a JPEG of an image of this size; choose PNG.");
  return new Uint8Array(await blob.arrayBuffer());
}

export function makeExportPanel(studio: Studio): Panel {
  const settings: ExportSettings = { name: "image", level: 0, layers: "compact", texture: "png", shading: "flat", width: null };
  let format: Format = kFormats[0]!, saving = false;

  const kinds = h("fieldset", { class: "formats" }, h("legend", {}, "What to save"));
  for (const each of kFormats) {
    const input = h("input", { type: "radio", name: "format", value: each.id, "aria-describedby": `format-${each.id}` });
    input.checked = each === format;
    input.addEventListener("change", () => {
      format = each;
      showUsed();
    });
    kinds.append(h("label", {}, input, h("b", {}, each.label), h("span", { class: "help", id: `format-${each.id}` }, each.help)));
  }

  const name = h("input", { type: "text", id: "export-name", autocomplete: "off", spellcheck: "false" });
  const width = h("input", { type: "number", id: "export-width", min: 1, max: kMostWidth, step: 1, inputmode: "numeric" });
  const level = h("select", { id: "export-level" });
  level.addEventListener("change", () => (settings.level = Number(level.value)));
  const field = (id: string, label: string, control: HTMLElement): HTMLElement =>
    h("div", { class: "field" }, h("div", { class: "field-head" }, h("label", { for: id }, label), control));
  const fields: Partial<Record<keyof ExportSettings, HTMLElement>> = {
    layers: choiceField<"compact" | "exr">("Pixel map", [
      { id: "compact", label: "Small", help: "A sixth of the bytes; imgmesh alone reads it." },
      { id: "exr", label: "As an image (EXR)", help: "Other programs can read it too." },
    ], (value) => (settings.layers = value)).element,
    texture: choiceField<"png" | "jpeg">("Image", [
      { id: "png", label: "Without loss (PNG)", help: "Every pixel as it is, transparency too." },
      { id: "jpeg", label: "Small (JPEG)", help: "Fewer bytes; there is no transparency." },
    ], (value) => (settings.texture = value)).element,
    shading: choiceField<Shading>("Triangles", [
      { id: "flat", label: "One colour each", help: "Clear facets." },
      { id: "gradient", label: "Gradients", help: "Nearer to the image; some programs draw it slowly." },
      { id: "wire", label: "Edges alone", help: "The wireframe, on nothing." },
    ], (value) => (settings.shading = value)).element,
    width: field("export-width", "Width in pixels", width),
    level: field("export-level", "Mesh", level),
  };

  const result = h("p", { class: "help", role: "status" });
  const main = h("button", { type: "submit", class: "main", id: "export" }, "Save");
  const form = h("form", { novalidate: true }, kinds, field("export-name", "File name", name), ...Object.values(fields), main, result);
  form.addEventListener("submit", (e) => {
    e.preventDefault();
    void save();
  });

  function showUsed(): void {
    const levels = studio.facts?.levels.length ?? 1;
    for (const [key, element] of Object.entries(fields))
      element.hidden = !format.uses.includes(key as keyof ExportSettings) || (key === "level" && levels < 2);
    main.disabled = saving || !studio.facts;
    result.textContent = studio.facts ? "" : "There is no mesh to save yet.";
  }

  async function save(): Promise<void> {
    const { session, picture, facts } = studio;
    if (!session || !picture || !facts) return studio.tell("There is no mesh to save yet.");
    settings.name = plainName(`${name.value}.x`);
    const wanted = width.valueAsNumber;
    if (format.uses.includes("width") && !(Number.isInteger(wanted) && wanted >= 1 && wanted <= kMostWidth)) {
      width.focus();
      return void studio.fail(new Error(`Width in pixels: a whole number from 1 to ${kMostWidth} is needed.`));
    }
    settings.width = format.uses.includes("width") && wanted !== facts.width ? wanted : null;
    saving = true;
    showUsed();
    result.textContent = "Making the file …";
    try {
      const files = await format.make(session, settings, () => jpegOf(picture.pixels));
      for (const file of files) studio.save(file.name, file.bytes, typeOf(file));
      const size = files.reduce((sum, { bytes }) => sum + bytes.length, 0);
      saving = false;
      showUsed();
      const { vertices } = facts.levels[settings.level] ?? facts.levels[0]!;
      result.textContent = `Saved ${files.map((file) => file.name).join(", ")}: ${bytesText(size)}, ${vertices} vertices.`;
    } catch (error) {
      saving = false;
      showUsed();
      result.textContent = "";
      studio.fail(studio.session === session ? error : new Error("The mesh was built anew while the file was being made. Save it again."));
    }
  }

  studio.on("picture", () => {
    if (studio.picture) name.value = plainName(studio.picture.name);
    width.value = studio.picture ? String(studio.picture.pixels.width) : "";
  });
  studio.on("mesh", () => {
    const levels = studio.facts?.levels ?? [];
    level.replaceChildren(
      ...levels.map(({ vertices }, k) => h("option", { value: k }, k === 0 ? `the finest, ${vertices} vertices` : `${vertices} vertices`)),
    );
    settings.level = 0;
    showUsed();
  });
  showUsed();
  return { id: "export", title: "Export", element: h("div", { class: "panel" }, form), show: showUsed, hide: () => {} };
}

function typeOf({ name }: NamedFile): string {
  return kTypes[name.slice(name.lastIndexOf(".") + 1)] ?? "application/octet-stream";
}
