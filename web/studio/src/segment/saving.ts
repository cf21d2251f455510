// What the panel saves, in words and as files.
import type { Picture, Session, Studio } from "../contracts";
import type { RegionEditor } from "./editor";
import { imagePng, labelsPng, maskPng, npy } from "./files";

export type FileKind = "labels.png" | "labels.npy" | "colors.png" | "flat.png" | "outlines.png" | "regions.svg" | "contours.npy" | "cut-out.png" | "mask.png";

export const kFileKinds: readonly { id: FileKind; label: string; help: string }[] = [
  { id: "regions.svg", label: "Shapes (SVG)", help: "A shape for each region in its mean colour, for Inkscape and cutters." },
  { id: "labels.png", label: "Labels (PNG)", help: "The number of each pixel's region, grey of 16 bits." },
  { id: "labels.npy", label: "Labels (numpy)", help: "The number of each pixel's region, for Python." },
  { id: "colors.png", label: "Colours (PNG)", help: "Each region in a colour of its own." },
  { id: "flat.png", label: "Mean colours (PNG)", help: "Each region in the mean of its pixels." },
  { id: "outlines.png", label: "Outlines (PNG)", help: "The image with the regions' borders." },
  { id: "contours.npy", label: "Contour map (numpy)", help: "Between two pixels, the threshold at which their regions become one." },
  { id: "cut-out.png", label: "Cut-out (PNG)", help: "What is kept; all else is transparent. Mark it with Keep and Drop first." },
  { id: "mask.png", label: "Mask of the cut-out (PNG)", help: "White inside and black outside, as imgmesh-build --mask takes it." },
];

/** Makes a file of the regions as they are now. Throws with one line where something is missing. */
export async function fileOf(kind: FileKind, editor: RegionEditor, session: Session, picture: Picture): Promise<{ bytes: Uint8Array | string; type: string }> {
  const { regions, inside } = editor, { width, height } = regions.data, { table } = regions;
  const image = (bytes: Uint8Array) => ({ bytes, type: "image/png" });
  const array = (bytes: Uint8Array) => ({ bytes, type: "application/octet-stream" });
  const kept = (): Uint8Array => {
    if (!inside) throw new Error("Nothing is kept yet: choose Keep, and draw over the object.");
    return inside;
  };
  const drawn = async (what: "outlines" | "flat" | "colors") => image(await imagePng(await session.ask("segment.draw", { what, table })));
  switch (kind) {
    case "labels.png": return image(await labelsPng(width, height, regions.labels()));
    case "labels.npy": return array(npy(width, height, regions.labels()));
    case "colors.png": return drawn("colors");
    case "flat.png": return drawn("flat");
    case "outlines.png": return drawn("outlines");
    case "regions.svg": return { bytes: await session.ask("segment.svg", { table }), type: "image/svg+xml" };
    case "contours.npy": {
      const map = await session.ask("segment.contours", {});
      return array(npy(map.width, map.height, map.data));
    }
    case "mask.png": return image(await maskPng(width, height, kept()));
    case "cut-out.png": {
      const data = new Uint8ClampedArray(picture.pixels.data), mask = kept();
      for (let i = 0; i < mask.length; ++i) if (!mask[i]) data.fill(0, 4 * i, 4 * i + 4);
      return image(await imagePng({ width, height, data }));
    }
  }
}

export async function saveKind(kind: FileKind, studio: Studio, editor: RegionEditor): Promise<void> {
  const { session, picture } = studio;
  if (!session || !picture) return;
  const { bytes, type } = await fileOf(kind, editor, session, picture);
  studio.save(`${picture.name.replace(/\.[^.]*$/, "")}-${kind}`, bytes, type);
}
