// What the parts of the page agree on. Each panel is a folder or file of its own that knows only this file and
// the package; each part of the worker adds its methods to Methods and its members to WorkerState by
// declaration merging:
//
//     declare module "../contracts" {
//       interface Methods { "warp.solve": { args: { handles: Handle[] }; result: Float32Array } }
//       interface WorkerState { warp?: Warp }
//     }
import type { Imgmesh, Mesh, MeshFacts, Pixels } from "imgmesh.wasm";

export type { MeshFacts, Pixels };

/** The methods of a session, by name: their arguments and results. Typed arrays in results are moved. */
// eslint-disable-next-line @typescript-eslint/no-empty-object-type
export interface Methods {}

export type Method = keyof Methods;
export type Args<M extends Method> = Methods[M] extends { args: infer A } ? A : never;
export type Result<M extends Method> = Methods[M] extends { result: infer R } ? R : never;

/** Is told the fraction done, and what is being done, by long methods. */
export type Report = (fraction: number, stage: string) => void;

/** What a part of the worker exports as `methods(state)`. */
export type MethodTable<Prefix extends string> = {
  [M in Method & `${Prefix}.${string}`]: (args: Args<M>, report: Report) => Result<M> | Promise<Result<M>>;
};

/** What one worker holds: the engine, one image and its mesh. */
export interface WorkerState {
  imgmesh: Imgmesh;
  pixels: Pixels | null;
  mesh: Mesh | null;
}

/**
 * One worker, that is, one image and its mesh. A build starts in a new session, which replaces the old one when
 * it has succeeded; closing a session ends its worker at once and gives its memory back.
 */
export interface Session {
  /** Calls a method. `transfer` is moved, not copied. Rejects with what the method threw, or when the worker is lost. */
  ask<M extends Method>(method: M, args: Args<M>, transfer?: Transferable[], onProgress?: Report): Promise<Result<M>>;
  close(): void;
}

export interface Point {
  x: number;
  y: number;
}

/** Between image pixels, (0, 0) being the centre of the top left one, and CSS pixels of the canvas. */
export interface ViewTransform {
  /** CSS pixels that an image pixel takes. */
  readonly scale: number;
  /** Where the corner of the image (-0.5, -0.5) lies, in CSS pixels of the canvas. */
  readonly x: number;
  readonly y: number;
  /** Size of the canvas in CSS pixels, and device pixels for each of them. */
  readonly width: number;
  readonly height: number;
  readonly ratio: number;
  toScreen(p: Point): Point;
  toImage(p: Point): Point;
}

/**
 * One side of the split view. An image source is stretched over the image; a function draws in CSS pixels and
 * draws only what the canvas shows.
 */
export interface Layer {
  width: number;
  height: number;
  source: CanvasImageSource | ((context: CanvasRenderingContext2D, transform: ViewTransform) => void);
  /** Pixels stay squares when they are large (the default). */
  smooth?: boolean;
}

export interface ViewPointer extends Point {
  shift: boolean;
  alt: boolean;
  ctrl: boolean;
  /** What 8 CSS pixels (20 for a finger) are in image pixels: how far one may miss. */
  tolerance: number;
}

/** Is drawn over both sides, in CSS pixels, and may take pointer and keys before the view does. */
export interface Overlay {
  draw?(context: CanvasRenderingContext2D, transform: ViewTransform): void;
  /** Returns true to take the drag that begins here. */
  pointerDown?(pointer: ViewPointer): boolean;
  pointerMove?(pointer: ViewPointer): void;
  pointerUp?(pointer: ViewPointer): void;
  pointerHover?(pointer: ViewPointer): void;
  /** Is given the keys that the canvas gets while it has the focus. Returns true to take one. */
  keyDown?(event: KeyboardEvent): boolean;
}

export interface ImageView {
  readonly element: HTMLElement;
  readonly transform: ViewTransform;
  /** Shows two layers beside the split; null shows nothing there. Equal layers hide the split. */
  setSides(left: Layer | null, right: Layer | null): void;
  /** Returns the function that takes the overlay away. Later overlays lie above, and are asked first; `below` puts one under all. */
  addOverlay(overlay: Overlay, below?: boolean): () => void;
  /** Draws again before the next frame. */
  invalidate(): void;
  /** Shows the whole image. */
  fit(): void;
}

export interface Picture {
  /** Of the file, without its folder. */
  name: string;
  pixels: Pixels;
  bitmap: ImageBitmap;
  /** Whether pixels are those of a file; a container that was opened alone has only its reconstruction. */
  original: boolean;
}

/** The page as panels see it. */
export interface Studio {
  readonly view: ImageView;
  readonly session: Session | null;
  readonly picture: Picture | null;
  /** Of the mesh that the session holds; null while there is none. */
  readonly facts: MeshFacts | null;
  /** Says one line in the status bar; screen readers read it out. */
  tell(text: string): void;
  /** Says what went wrong, in one line. Returns the function that takes the line away, if it is still there. */
  fail(error: unknown): () => void;
  /** Hands a file to the user. */
  save(name: string, bytes: Uint8Array | string, type: string): void;
  /** "picture": another image is there, without a mesh yet. "mesh": session and facts are new, or gone (null). */
  on(event: "picture" | "mesh", listener: () => void): void;
  /** Shows a panel's own sides in place of those that the user chose, without their wireframe, until showChosenSides(). */
  showOwnSides(left: Layer | null, right: Layer | null): void;
  /** Shows the sides that the user chose again, after a panel has shown its own. */
  showChosenSides(): void;
}

/** A tab. It is made by makeXPanel(studio) and registered in main.ts. */
export interface Panel {
  readonly id: string;
  readonly title: string;
  readonly element: HTMLElement;
  /** Called when the tab opens and closes: overlays are added and taken away here. */
  show(): void;
  hide(): void;
}
