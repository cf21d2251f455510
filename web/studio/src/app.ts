// The page's state: one picture, its session, and what is being built.
import type { ImageView, Layer, MeshFacts, Picture, Report, Session, Studio } from "./contracts";
import type { BuildOptions, BuildParameters, NamedFile } from "imgmesh.wasm";
import { bitmapOf } from "./open/bitmap";
import { startSession } from "./session";

type Event = "picture" | "mesh" | "build";

export interface Messages {
  tell(text: string): void;
  fail(text: string): () => void;
}

export class App implements Studio {
  readonly view: ImageView;
  session: Session | null = null;
  picture: Picture | null = null;
  facts: MeshFacts | null = null;
  /** How long the last build took, in seconds; null for a container. */
  seconds: number | null = null;
  /** Bytes of the container that was opened; null for a mesh that was built here. */
  bytes: number | null = null;
  /** The session that is building. */
  private building: Session | null = null;
  private readonly listeners: [Event, () => void][] = [];
  private readonly messages: Messages;
  showChosenSides: () => void = () => {};
  showOwnSides: (left: Layer | null, right: Layer | null) => void = () => {};

  constructor(view: ImageView, messages: Messages) {
    this.view = view;
    this.messages = messages;
  }

  on(event: Event, listener: () => void): void {
    this.listeners.push([event, listener]);
  }

  private emit(event: Event): void {
    for (const [of, listener] of this.listeners) if (of === event) listener();
  }

  tell(text: string): void {
    this.messages.tell(text);
  }

  fail(error: unknown): () => void {
    return this.messages.fail(error instanceof Error ? error.message : String(error));
  }

  save(name: string, bytes: Uint8Array | string, type: string): void {
    const url = URL.createObjectURL(new Blob([bytes as BlobPart], { type }));
    const link = document.createElement("a");
    link.href = url;
    link.download = name;
    link.click();
    // The download has begun by then, or never will.
    setTimeout(() => URL.revokeObjectURL(url), 60_000);
    this.tell(`Saved ${name}.`);
  }

  get busy(): boolean {
    return this.building !== null;
  }

  /** Shows another picture. The mesh of the one before goes. */
  setPicture(picture: Picture): void {
    this.stop();
    this.session?.close();
    this.session = null;
    this.facts = null;
    this.usePicture(picture);
    this.emit("mesh");
  }

  private usePicture(picture: Picture): void {
    this.picture?.bitmap.close();
    this.picture = picture;
    this.emit("picture");
  }

  /**
   * Builds a mesh of the picture in a session of its own. The old mesh stays until the new one is there; a
   * build that is still running is stopped. Resolves to whether the new mesh is there.
   */
  build(parameters: BuildParameters, options: BuildOptions, onProgress: Report): Promise<boolean> {
    const { picture } = this;
    if (!picture) return Promise.resolve(false);
    const start = performance.now();
    return this.inNewSession(async (session) => {
      const facts = await session.ask("build.start", { pixels: picture.pixels, parameters, options }, [], onProgress);
      return () => {
        this.facts = facts;
        this.seconds = (performance.now() - start) / 1000;
        this.bytes = null;
      };
    });
  }

  /**
   * Opens a container in a session of its own. It is compared with `original`, the image that it was made of,
   * where that came with it. Resolves to whether it is open; the bytes of `files` are moved.
   */
  openContainer(name: string, files: NamedFile[], original: Picture | null): Promise<boolean> {
    const size = files.reduce((sum, { bytes }) => sum + bytes.length, 0);
    return this.inNewSession(async (session) => {
      const moved = files.map(({ bytes }) => bytes.buffer as ArrayBuffer);
      const { facts, pixels } = await session.ask("export.open", { files }, moved);
      if (!pixels) throw new Error(`${name} has no colours that a page could show.`);
      const fits = original?.pixels.width === facts.width && original?.pixels.height === facts.height;
      if (original && !fits) throw new Error(`${original.name} has another size than the image in ${name}.`);
      const picture = original ?? { name, pixels, bitmap: await bitmapOf(pixels), original: false };
      if (original) await session.ask("build.compareWith", { pixels: original.pixels });
      return () => {
        this.usePicture(picture);
        this.facts = facts;
        this.seconds = null;
        this.bytes = size;
      };
    });
  }

  /**
   * Runs `work` in a new session, which becomes the page's if it succeeds. What it returns is called then.
   * Resolves to false where it was stopped or replaced.
   */
  private async inNewSession(work: (session: Session) => Promise<() => void>): Promise<boolean> {
    this.building?.close();
    const session = startSession();
    this.building = session;
    this.emit("build");
    try {
      const use = await work(session);
      if (this.building !== session) return false;
      this.building = null;
      this.session?.close();
      this.session = null;
      use();
      this.session = session;
      this.emit("build");
      this.emit("mesh");
      return true;
    } catch (error) {
      session.close();
      if (this.building !== session) return false; // stopped or replaced, as was wanted
      this.building = null;
      this.emit("build");
      throw error;
    }
  }

  /** Stops the build that is running. Returns whether there was one. */
  stop(): boolean {
    if (!this.building) return false;
    const session = this.building;
    this.building = null;
    session.close();
    this.emit("build");
    return true;
  }
}
