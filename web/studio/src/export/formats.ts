// The kinds of file that the page saves, in plain words.
import type { NamedFile } from "imgmesh.wasm";
import type { Session } from "../contracts";
import type { TextureChoice } from "../worker/export";

export type FormatId = "container" | "mesh" | "textured" | "poster" | "sprite" | "obj" | "ply" | "picture";
export type Shading = "flat" | "gradient" | "wire";

/** What the controls of the panel say. */
export interface ExportSettings {
  /** Of the file, without its ending. */
  name: string;
  level: number;
  layers: "compact" | "exr";
  /** Of the image on a mesh; "jpeg" only without transparency. */
  texture: "png" | "jpeg";
  shading: Shading;
  /** Of the poster, in pixels; null: as the image. */
  width: number | null;
}

export interface Format {
  id: FormatId;
  label: string;
  help: string;
  /** The controls that count for it. */
  uses: readonly (keyof ExportSettings)[];
  /** The largest first file, then its companions. `picture` gives the bytes of a JPEG of the image. */
  make(session: Session, settings: ExportSettings, jpeg: () => Promise<Uint8Array>): Promise<NamedFile[]>;
}

const textFile = (name: string, text: string): NamedFile => ({ name, bytes: new TextEncoder().encode(text) });

async function textureOf(settings: ExportSettings, jpeg: () => Promise<Uint8Array>): Promise<TextureChoice> {
  return settings.texture === "jpeg" ? jpeg() : "png";
}

/** The poster with sides of its own; a viewer stretches the drawing to them. */
export function resized(svg: string, width: number | null): string {
  if (width === null) return svg;
  return svg.replace(/width="(\d+)" height="(\d+)"/, (_, w: string, h: string) => {
    const height = Math.max(1, Math.round((width * Number(h)) / Number(w)));
    return `width="${width}" height="${height}"`;
  });
}

export const kFormats: readonly Format[] = [
  {
    id: "container",
    label: "Container (.glb)",
    help: "Everything: the mesh and where each pixel lies on it. Opens here and in imgmesh's programs; 3D viewers show the mesh.",
    uses: ["layers"],
    make: (session, { name, layers }) =>
      session.ask("export.container", { options: { name: `${name}.glb`, layers } }),
  },
  {
    id: "mesh",
    label: "3D mesh (.glb)",
    help: "Triangles with the colours of their corners, for 3D programs and engines.",
    uses: [],
    make: (session, { name }) => session.ask("export.container", { options: { name: `${name}.glb`, layers: "none" } }),
  },
  {
    id: "textured",
    label: "3D mesh with the image on it (.glb)",
    help: "Looks like the image, and bends with the mesh. For 3D programs and engines.",
    uses: ["texture"],
    make: async (session, settings, jpeg) =>
      session.ask("export.container", {
        options: { name: `${settings.name}.glb`, layers: "none" },
        texture: await textureOf(settings, jpeg),
      }),
  },
  {
    id: "poster",
    label: "Poster (.svg)",
    help: "A drawing of the triangles that stays sharp at any size, to print and for web pages.",
    uses: ["shading", "width", "level"],
    make: async (session, { name, shading, level, width }) => [
      textFile(`${name}.svg`, resized(await session.ask("export.svg", { shading, level }), width)),
    ],
  },
  {
    id: "sprite",
    label: "Sprite (.json and .png)",
    help: "The image with its mesh, as TexturePacker makes it and PixiJS reads it.",
    uses: ["level"],
    make: async (session, { name, level }) => [
      textFile(`${name}.json`, await session.ask("export.text", { format: "json", level, image: `${name}.png` })),
      { name: `${name}.png`, bytes: await session.ask("export.png", { of: "image", level }) },
    ],
  },
  {
    id: "obj",
    label: "Wavefront (.obj, .mtl and image)",
    help: "The mesh with the image on it, for 3D programs that do not read .glb.",
    uses: ["level", "texture"],
    make: async (session, settings, jpeg) =>
      session.ask("export.obj", {
        name: settings.name,
        level: settings.level,
        texture: await textureOf(settings, jpeg),
      }),
  },
  {
    id: "ply",
    label: "Points and triangles (.ply)",
    help: "The mesh with the colours of its corners as plain text, for MeshLab and research code.",
    uses: ["level"],
    make: async (session, { name, level }) => [
      textFile(`${name}.ply`, await session.ask("export.text", { format: "ply", level, image: "" })),
    ],
  },
  {
    id: "picture",
    label: "Reconstruction (.png)",
    help: "The image as the mesh gives it back.",
    uses: ["level"],
    make: async (session, { name, level }) => [
      { name: `${name}.png`, bytes: await session.ask("export.png", { of: "reconstruction", level }) },
    ],
  },
];
