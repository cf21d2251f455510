// The page's state: one picture, its session, and what is being built.
import type { BuildOptions, BuildParameters } from "imgmesh.wasm";
import type { ImageView, Layer, MeshFacts, Picture, Report, Session, Studio } from "./contracts";
import { startSession } from "./session";

type Event = "picture" | "mesh" | "build";

export interface Messages {
  tell(text: string): void;
  fail(text: string): void;
}

export class App implements Studio {
  readonly view: ImageView;
  session: Session | null = null;
  picture: Picture | null = null;
  facts: MeshFacts | null = null;
  /** How long the last build took, in seconds; null for a container. */
  seconds: number | null = null;
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

  fail(error: unknown): void {
    this.messages.fail(error instanceof Error ? error.message : String(error));
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
    this.picture?.bitmap.close();
    this.picture = picture;
    this.emit("picture");
    this.emit("mesh");
  }

  /**
   * Builds a mesh of the picture in a session of its own. The old mesh stays until the new one is there; a
   * build that is still running is stopped. Resolves to whether the new mesh is there.
   */
  async build(parameters: BuildParameters, options: BuildOptions, onProgress: Report): Promise<boolean> {
    const picture = this.picture;
    if (!picture) return false;
    this.building?.close();
    const session = startSession();
    this.building = session;
    this.emit("build");
    const start = performance.now();
    try {
      const facts = await session.ask("build.start", { pixels: picture.pixels, parameters, options }, [], onProgress);
      if (this.building !== session) return false;
      this.building = null;
      this.session?.close();
      this.session = session;
      this.facts = facts;
      this.seconds = (performance.now() - start) / 1000;
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
