// One level's mesh as the hand needs it: which vertex is where.
import type { Point } from "../contracts";
import type { MeshArrays } from "../worker/view";

export class LevelMesh {
  readonly arrays: MeshArrays;
  /** Whether a vertex is on the border of the mesh. */
  readonly border: Uint8Array;
  /** The usual length of an edge, in pixels. */
  readonly spacing: number;
  /** How far vertices usually are from their nearest neighbour, in pixels: less than spacing, where many crowd. */
  readonly gap: number;
  private readonly first: Uint32Array;
  private readonly neighbors: Uint32Array;

  constructor(arrays: MeshArrays) {
    this.arrays = arrays;
    const { positions, faces, edges } = arrays, count = positions.length / 2;
    this.border = new Uint8Array(count);
    const sides = new Map<number, number>();
    for (let f = 0; f < faces.length; f += 3)
      for (let k = 0; k < 3; ++k) {
        const a = faces[f + k]!, b = faces[f + ((k + 1) % 3)]!;
        const key = Math.min(a, b) * count + Math.max(a, b);
        sides.set(key, (sides.get(key) ?? 0) + 1);
      }
    for (const [key, uses] of sides)
      if (uses === 1) this.border[Math.floor(key / count)] = this.border[key % count] = 1;
    this.first = new Uint32Array(count + 1);
    for (const v of edges) this.first[v + 1]!++;
    for (let v = 0; v < count; ++v) this.first[v + 1]! += this.first[v]!;
    const next = this.first.slice(0, count);
    this.neighbors = new Uint32Array(edges.length);
    const shortest = new Float32Array(count).fill(Infinity);
    let total = 0;
    for (let i = 0; i < edges.length; i += 2) {
      const a = edges[i]!, b = edges[i + 1]!;
      this.neighbors[next[a]!++] = b;
      this.neighbors[next[b]!++] = a;
      const length = Math.hypot(positions[2 * a]! - positions[2 * b]!, positions[2 * a + 1]! - positions[2 * b + 1]!);
      total += length;
      for (const v of [a, b]) shortest[v] = Math.min(shortest[v]!, length);
    }
    const gaps = shortest.filter(Number.isFinite);
    this.gap = gaps.length > 0 ? gaps.reduce((a, b) => a + b, 0) / gaps.length : 1;
    this.spacing = edges.length > 0 ? (2 * total) / edges.length : 1;
  }

  get count(): number {
    return this.border.length;
  }

  /** The vertex nearest to a point, by `places`; `allowed` chooses among them. */
  nearest(p: Point, places: Float32Array, allowed: (v: number) => boolean = () => true): { vertex: number; distance: number } | null {
    let vertex = -1, least = Infinity;
    for (let v = 0; v < this.count; ++v) {
      const d = Math.hypot(places[2 * v]! - p.x, places[2 * v + 1]! - p.y);
      if (d < least && allowed(v)) [vertex, least] = [v, d];
    }
    return vertex < 0 ? null : { vertex, distance: least };
  }

  /** The neighbour of a vertex that lies most in a direction; the vertex itself if none does. */
  towards(vertex: number, dx: number, dy: number, places: Float32Array): number {
    let best = vertex, most = 0.2;
    for (let k = this.first[vertex]!; k < this.first[vertex + 1]!; ++k) {
      const n = this.neighbors[k]!;
      const x = places[2 * n]! - places[2 * vertex]!, y = places[2 * n + 1]! - places[2 * vertex + 1]!;
      const along = (x * dx + y * dy) / (Math.hypot(x, y) || 1);
      if (along > most) [best, most] = [n, along];
    }
    return best;
  }
}
