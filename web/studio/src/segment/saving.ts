// What the panel saves, in words and as files.
import type { Picture, Session, Studio } from "../contracts";
import type { RegionEditor } from "./editor";

export type FileKind =
  | "labels.png" | "labels.npy" | "labels.tif" | "labels.mat" | "colors.png" | "flat.png" | "outlines.png" | "regions.svg"
  | "pieces.glb" | "contours.npy" | "cut-out.png" | "mask.png";

export const kFileKinds: readonly { id: FileKind; label: string; help: string }[] = [
  { id: "regions.svg", label: "Shapes (SVG)", help: "A shape for each region in its mean colour, for Inkscape and cutters." },
  { id: "colors.png", label: "Colours (PNG)", help: "Each region in a colour of its own, unlike its neighbours’." },
  { id: "flat.png", label: "Mean colours (PNG)", help: "Each region in the mean of its pixels." },
  { id: "outlines.png", label: "Outlines (PNG)", help: "The image with the regions’ borders." },
  { id: "cut-out.png", label: "Cut-out (PNG)", help: "What is kept; all else is transparent. Mark it with Keep and Drop first." },
  { id: "mask.png", label: "Mask of the cut-out (PNG)", help: "White inside and black outside, as imgmesh-build --mask takes it." },
  { id: "pieces.glb", label: "Mesh in pieces (.glb)", help: "Each region with a material of its own, for modelling programs." },
  { id: "labels.png", label: "Labels (PNG)", help: "The number of each pixel’s region, grey of 16 bits." },
  { id: "labels.npy", label: "Labels (numpy)", help: "The number of each pixel’s region, for Python." },
  { id: "labels.tif", label: "Labels (TIFF)", help: "The number of each pixel’s region, for maps and ImageJ." },
  { id: "labels.mat", label: "Labels (MATLAB)", help: "The number of each pixel’s region, counted from 1." },
  { id: "contours.npy", label: "Contour map (numpy)", help: "Between two pixels, the threshold at which their regions become one." },
];

/** Makes a file of the regions as they are now. Throws with one line where something is missing. */
async function bytesOf(kind: FileKind, editor: RegionEditor, session: Session, { pixels }: Picture): Promise<Uint8Array | string> {
  const table = editor.regions.table.slice();
  if ((kind === "cut-out.png" || kind === "mask.png") && !editor.inside)
    throw new Error("Nothing is kept yet: choose Keep, and draw over the object.");
  switch (kind) {
    case "regions.svg": return session.ask("segment.svg", { table });
    case "colors.png": return session.ask("segment.drawing", { what: "colors", table });
    case "flat.png": return session.ask("segment.drawing", { what: "flat", table });
    case "outlines.png": return session.ask("segment.drawing", { what: "outlines", table });
    case "cut-out.png": return session.ask("segment.cutOut", { pixels, inside: editor.inside! });
    case "mask.png": return session.ask("segment.maskPng", { table, keep: editor.lines(true), drop: editor.lines(false) });
    case "pieces.glb": return session.ask("segment.pieces", { table });
    case "contours.npy": return session.ask("segment.contourFile", { name: kind });
    default: return session.ask("segment.labels", { name: kind, labels: editor.regions.labels() });
  }
}

const kTypes: Record<string, string> = { png: "image/png", svg: "image/svg+xml", glb: "model/gltf-binary", tif: "image/tiff" };

export async function saveKind(kind: FileKind, studio: Studio, editor: RegionEditor): Promise<void> {
  const { session, picture } = studio;
  if (!session || !picture) return;
  const bytes = await bytesOf(kind, editor, session, picture);
  const type = kTypes[kind.split(".").pop()!] ?? "application/octet-stream";
  studio.save(`${picture.name.replace(/\.[^.]*$/, "")}-${kind}`, bytes, type);
}
