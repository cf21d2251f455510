// The tiles of a set, drawn straight from the front by three.js and the 3D Tiles renderer of NASA-AMMOS.
import { TilesRenderer, type Tile } from "3d-tiles-renderer";
import { Box3, type Object3D, OrthographicCamera, Scene, Vector3, WebGLRenderer } from "three";
import { DRACOLoader } from "three/addons/loaders/DRACOLoader.js";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import type { Transform } from "../../studio/src/view/transform";
import { type Levels, levelsOf, sizeOf, type TilesetFile } from "./levels";
import { pathInSet, type SetSource, withOneSlash } from "./set_source";
import { addWire, pictureMeshes, wireMaterial } from "./wire";

/** Zooms such as 50 % are a little more or less than they say. */
const kRounding = 1e-4;

/** A tile that is on the screen. Its rectangle is in pixels of the picture. */
export interface ShownTile {
  readonly level: number;
  readonly triangles: number;
  readonly left: number;
  readonly top: number;
  readonly right: number;
  readonly bottom: number;
}

export interface SceneEvents {
  /** The set is there. Its picture has this size [px]. */
  opened(size: { width: number; height: number }): void;
  /** There is something new to draw. */
  changed(): void;
  /** One line for the reader. `broken` is false if there is no set at all. */
  failed(text: string, broken: boolean): void;
}

export class TileScene {
  wire = false;
  private readonly renderer: WebGLRenderer;
  private readonly camera = new OrthographicCamera();
  private readonly scene = new Scene();
  private readonly lines = wireMaterial();
  private readonly gltf = new GLTFLoader();
  private readonly events: SceneEvents;
  private tiles: TilesRenderer | null = null;
  private levels: Levels = { spacing: 1, of: () => 0 };
  private known = new WeakMap<Tile, ShownTile>();
  private readonly numbers = new WeakMap<Tile, number>(); // levels
  private depth = 1; // of the set's box [px]: how far skirts may lie behind the picture
  private loaded = 0;
  private broken: string[] = [];

  /** Throws if the browser cannot draw in three dimensions. */
  constructor(canvas: HTMLCanvasElement, events: SceneEvents) {
    this.events = events;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.setClearAlpha(0);
    const decoder = new DRACOLoader();
    const file = (name: string): string => new URL(name, import.meta.url).href;
    decoder.setDecoderPath({ js: file("draco_wasm_wrapper.js"), wasm: file("draco_decoder.wasm") });
    this.gltf.setDRACOLoader(decoder);
  }

  /** Shows another set. What was shown before goes at once. */
  open(source: SetSource): void {
    if (this.tiles) {
      this.scene.remove(this.tiles.group);
      this.tiles.dispose();
    }
    this.loaded = 0;
    this.broken = [];
    this.known = new WeakMap();
    const tiles = (this.tiles = new TilesRenderer(source.url));
    tiles.manager.addHandler(/\.(glb|gltf)$/i, this.gltf);
    tiles.registerPlugin({ preprocessURL: (url: string) => withOneSlash(url) });
    const { read } = source;
    if (read)
      tiles.registerPlugin({ fetchData: async (url: string) => new Response(await read(pathInSet(source, url))) });
    tiles.setCamera(this.camera);
    this.scene.add(tiles.group);
    tiles.addEventListener("load-root-tileset", ({ tileset }) => this.start(tiles, tileset as unknown as TilesetFile));
    tiles.addEventListener("load-model", ({ scene, tile }) => {
      this.loaded += 1;
      this.known.set(tile, this.describe(scene, tile));
      addWire(scene, this.lines);
      this.events.changed();
    });
    tiles.addEventListener("dispose-model", () => (this.loaded -= 1));
    tiles.addEventListener("load-error", ({ tile, url }) => {
      if (tiles === this.tiles) this.fail(source, tile, String(url));
    });
    for (const name of ["needs-update", "tile-visibility-change", "tiles-load-end"] as const)
      tiles.addEventListener(name, () => this.events.changed());
    this.events.changed();
  }

  /** Draws one frame, and asks for the tiles that it lacks. */
  draw(transform: Transform): void {
    const { camera, renderer, tiles, lines } = this, { width, height, ratio, scale } = transform;
    renderer.setPixelRatio(ratio);
    renderer.setSize(width, height, false);
    // What lies at the middle of the view is near 0 for the camera, where floats are finest.
    const middle = transform.toImage({ x: width / 2, y: height / 2 });
    camera.position.set(middle.x, -middle.y, this.depth);
    [camera.near, camera.far] = [0, 2 * this.depth];
    [camera.left, camera.right] = [-width / 2 / scale, width / 2 / scale];
    [camera.bottom, camera.top] = [-height / 2 / scale, height / 2 / scale];
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
    // A level is fine enough as long as its triangles are not larger than those of level 0 at 50 %: at its full
    // size a mesh looks soft, and who opens a set sees a coarser level first.
    if (tiles) {
      tiles.errorTarget = 0.5 * this.levels.spacing * (1 + kRounding);
      tiles.setResolution(camera, width * ratio, height * ratio);
      tiles.update();
    }
    const coarsest = Math.max(0, ...this.shown().map(({ level }) => level));
    lines.visible = this.wire;
    lines.uniforms["spacing"]!.value = this.levels.spacing * 2 ** coarsest * scale;
    renderer.render(this.scene, camera);
  }

  /** The tiles of the last frame. */
  shown(): ShownTile[] {
    const shown: ShownTile[] = [];
    for (const tile of this.tiles?.visibleTiles ?? []) {
      const facts = this.known.get(tile);
      if (facts) shown.push(facts);
    }
    return shown;
  }

  /** Of the set, in memory. */
  get loadedTiles(): number {
    return this.loaded;
  }

  /** Whether tiles of this view are still on their way. */
  get loading(): boolean {
    return this.tiles !== null && this.tiles.loadProgress < 1;
  }

  private start(tiles: TilesRenderer, tileset: TilesetFile): void {
    if (tiles !== this.tiles) return;
    this.levels = levelsOf(tileset);
    const box = new Box3();
    tiles.getBoundingBox(box);
    const size = box.getSize(new Vector3());
    this.depth = Math.max(size.z, 1);
    this.events.opened(sizeOf(tileset, size));
  }

  private describe(scene: Object3D, tile: Tile): ShownTile {
    const box = new Box3();
    let triangles = 0;
    scene.updateMatrixWorld(true);
    for (const { geometry, matrixWorld } of pictureMeshes(scene)) {
      geometry.computeBoundingBox();
      box.union(geometry.boundingBox!.clone().applyMatrix4(matrixWorld));
      triangles += (geometry.index ?? geometry.attributes["position"]!).count / 3;
    }
    return { level: this.levelOf(tile), triangles, left: box.min.x, right: box.max.x, top: -box.max.y, bottom: -box.min.y };
  }

  /** Is asked before fail() changes a tile's error. */
  private levelOf(tile: Tile): number {
    const level = this.numbers.get(tile) ?? this.levels.of(tile);
    this.numbers.set(tile, level);
    return level;
  }

  private fail(source: SetSource, tile: Tile | null, url: string): void {
    if (!tile) {
      this.events.failed(`There is no tile set at ${source.read ? source.name : source.url}`, false);
      return;
    }
    // Its parent stays: a coarser picture is better than a hole.
    if (tile.parent) {
      this.levelOf(tile.parent);
      tile.parent.geometricError = 0;
    }
    this.broken.push(pathInSet(source, url));
    const [first, ...others] = this.broken;
    const which = others.length > 0 ? `${this.broken.length} tiles, ${first} the first of them,` : `The tile ${first}`;
    this.events.failed(`${which} could not be read; ${tile.parent ? "a coarser one is shown there" : "nothing is shown there"}`, true);
    this.events.changed();
  }
}
