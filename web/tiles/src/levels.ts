// What a tile set tells of its picture and its levels.

/** The part of a tileset.json that is read here. */
export interface TileNode {
  geometricError: number;
  children?: TileNode[];
}
export interface TilesetFile {
  root: TileNode;
  extras?: Record<string, unknown>;
}

/** Of sets that do not tell it: that of the default density. [px] */
const kUsualSpacing = 10;

export interface Levels {
  /** The mean distance of vertices of level 0 [px]. A level of twice the number has twice as much. */
  readonly spacing: number;
  of(tile: { geometricError: number }): number;
}

/** A tile of level k has the geometric error 2^k spacing, but those of level 0 have none. */
export function levelsOf({ root, extras }: TilesetFile): Levels {
  const told = Number(extras?.["spacing"]);
  let least = Infinity;
  for (let tile: TileNode | undefined = root; tile; tile = tile.children?.[0])
    if (tile.geometricError > 0) least = tile.geometricError;
  const spacing = told > 0 ? told : Number.isFinite(least) ? least / 2 : kUsualSpacing;
  return {
    spacing,
    of: ({ geometricError }) => (geometricError > 0 ? Math.max(Math.round(Math.log2(geometricError / spacing)), 0) : 0),
  };
}

/** The picture's size as the set tells it, or else of what its box holds: pixels lie on whole numbers. */
export function sizeOf({ extras }: TilesetFile, box: { x: number; y: number }): { width: number; height: number } {
  const side = (told: unknown, extent: number): number => (Number(told) > 0 ? Number(told) : Math.max(Math.round(extent) + 1, 1));
  return { width: side(extras?.["width"], box.x), height: side(extras?.["height"], box.y) };
}
