// Decodes coded meshes (.imgm, image/x-imgm) in browsers, workers and Node. It needs no other file:
//
//     import { decode, drawTo, info } from "./imgm.js";
//     drawTo(document.querySelector("canvas"), bytes);
//
// It draws the same pixels as imgmesh-decode, as docs/codec-format.md says: all arithmetic is that of whole numbers
// below 2^53. Names of steps are those of libcore/coding.

/**
 * @typedef {{ width: number, height: number, channels: number }} Info  channels: 1 grey, 2 grey and alpha, 3 RGB,
 *     4 RGBA
 * @typedef {{ width?: number, height?: number, scale?: number }} Size  pixels of the drawing; one side follows from
 *     the other; without any, the picture's own size times the scale
 * @typedef {Info & { data: Uint8ClampedArray }} Picture  data: RGBA, rows from the top, alpha not premultiplied
 */

const MAX_PIXELS = 2 ** 26, MAX_SIDE = 65535, NONE = -1;

const clamp = (x, low, high) => (x < low ? low : x > high ? high : x);
const { abs, floor, max, min } = Math;
// Exact for |a| < 2^52.
const divide = (a, b) => floor(a / b);
const rounded = (a, b) => divide(2 * a + b, 2 * b);
/** How many bits a number below 2^53 takes. */
const bitWidth = (x) => (x < 2 ** 32 ? 32 - Math.clz32(x) : 64 - Math.clz32(x / 2 ** 32));
const next = (i) => (i === 2 ? 0 : i + 1);
const before = (i) => (i === 0 ? 2 : i - 1);

function fail(text) {
  throw new Error(`the coded picture ${text}`);
}

// ---- Header

function readHeader(bytes) {
  if (bytes.length < 4 || bytes[0] !== 0x9a || bytes[1] !== 0x49 || bytes[2] !== 0x4d)
    fail("is none: it does not begin with its signature");
  if (bytes[3] >> 4 !== 1) fail(`has version ${bytes[3] >> 4}, not 1`);
  if (bytes[3] & 12) fail("has bits set that version 1 does not know");
  let at = 4;
  const side = () => {
    let number = 0;
    for (let shift = 0; shift < 21; shift += 7) {
      if (at === bytes.length) fail("ends too early");
      const byte = bytes[at++];
      number |= (byte & 127) << shift;
      if (byte < 128) return number + 1;
    }
    return fail("has a size of more than three bytes");
  };
  const width = side(), height = side();
  if (width > MAX_SIDE || height > MAX_SIDE || width * height > MAX_PIXELS)
    fail(`is ${width} x ${height} pixels, more than ${MAX_SIDE} a side or ${MAX_PIXELS} in all`);
  return { width, height, channels: (bytes[3] & 3) + 1, at };
}

// ---- Range coder and bit models

class RangeDecoder {
  constructor(bytes, at) {
    this.bytes = bytes;
    this.at = at;
    this.missing = 0;
    this.range = 2 ** 32 - 1;
    this.value = 0;
    for (let i = 0; i < 4; ++i) this.value = ((this.value << 8) | this.next()) >>> 0;
  }

  next() {
    if (this.at < this.bytes.length) return this.bytes[this.at++];
    ++this.missing;
    return 0;
  }

  /** A bit that is 1 with a probability, in 1/2^15. */
  bit(probability) {
    const bound = (this.range >>> 15) * probability, bit = this.value < bound;
    if (bit) this.range = bound;
    else {
      this.value -= bound;
      this.range -= bound;
    }
    while (this.range < 2 ** 24) {
      this.range *= 256;
      this.value = ((this.value << 8) | this.next()) >>> 0;
    }
    return bit ? 1 : 0;
  }

  bits(count) {
    let number = 0;
    while (count-- > 0) number = 2 * number + this.bit(1 << 14);
    return number;
  }

  /** An exponential Golomb code. */
  number(order, most = 31 - order) {
    let bits = 0;
    while (bits < most && this.bit(1 << 14)) ++bits;
    const high = 2 ** bits + this.bits(bits) - 1;
    return high * 2 ** order + this.bits(order);
  }

  checkEnd() {
    if (this.missing > 4) fail("ends too early");
  }
}

const MAX_ODDS = 2047;
const LOGISTIC = [22, 36, 60, 98, 162, 267, 439, 720, 1179, 1921, 3108, 4971, 7812, 11955, 17625, 24743, 32768];
const logistic = (i) => (i <= 16 ? LOGISTIC[i] : 65536 - LOGISTIC[32 - i]);
/** The probability of log odds in 1/256, in 1/2^16. */
const PROBABILITY = Int32Array.from({ length: 2 * MAX_ODDS + 1 }, (_, i) => {
  const part = (i + 1) & 127, k = (i + 1) >> 7;
  return (logistic(k) * (128 - part) + logistic(k + 1) * part + 64) >> 7;
});
/** The log odds of a probability in 1/2^12. */
const ODDS = new Int16Array(4096);
for (let p = 0, odds = -MAX_ODDS; p < 4096; ++p) {
  while (odds < MAX_ODDS && PROBABILITY[odds + MAX_ODDS] < 16 * p + 8) ++odds;
  ODDS[p] = odds;
}
const RATE = Int32Array.from({ length: 251 }, (_, seen) => divide(327680, 10 * seen + 25));

/** The contexts of the decision that comes next, and their log odds. */
const at = new Int32Array(5), odds = new Int32Array(6);

/** One kind of decision: each context counts on its own, and a logistic mix weighs them. */
class BitModel {
  /** @param {number[]} sizes  contexts of each input */
  constructor(sizes, sets = 1) {
    const inputs = sizes.length;
    this.inputs = inputs;
    this.first = sizes.map((_, i) => sizes.slice(0, i).reduce((a, b) => a + b, 0));
    const all = this.first[inputs - 1] + sizes[inputs - 1];
    this.probability = new Uint16Array(all).fill(1 << 15);
    this.seen = new Uint8Array(all);
    this.weight = new Int32Array(sets * (inputs + 1)).fill(floor((0.6 * (1 << 14)) / inputs));
    for (let set = 0; set < sets; ++set) this.weight[set * (inputs + 1) + inputs] = 1 << 14;
    this.settling = new Int32Array(sets);
  }

  /** Decodes the bit of the contexts `at`. prior: the log odds before anything was seen. */
  code(coder, prior = 0, set = 0) {
    const { inputs, first, probability, seen, weight } = this, from = set * (inputs + 1);
    let sum = 0;
    for (let i = 0; i < inputs; ++i) {
      at[i] += first[i];
      odds[i] = ODDS[probability[at[i]] >> 4];
      sum += weight[from + i] * odds[i];
    }
    odds[inputs] = prior;
    sum += weight[from + inputs] * prior;
    const mixed = PROBABILITY[clamp(sum >> 14, -MAX_ODDS, MAX_ODDS) + MAX_ODDS];
    const bit = coder.bit(clamp(mixed >> 1, 16, 32768 - 16)), target = bit ? 65535 : 0;
    const error = target - mixed, settled = this.settling[set] === 500, shift = settled ? 17 : 16;
    if (!settled) ++this.settling[set];
    for (let i = 0; i <= inputs; ++i)
      weight[from + i] = clamp(weight[from + i] + ((odds[i] * error + (1 << (shift - 1))) >> shift), -65536, 65536);
    for (let i = 0; i < inputs; ++i) {
      const c = at[i];
      probability[c] += ((target - probability[c]) * RATE[seen[c]]) >> 15;
      if (seen[c] < 250) ++seen[c];
    }
    return bit;
  }
}

// ---- Points: counts of vertices in cells that halve until each is one point of the grid

const LEVELS = 24, COUNTS = 16;
const pair = (a, b, most) => min(a, most) * (most + 1) + min(b, most);

/** 128 log2, by its first bits. */
function roughLog(n) {
  const whole = bitWidth(n) - 1;
  return whole * 128 + (whole >= 7 ? n >> (whole - 7) : n << (7 - whole)) - 128;
}

class HalvesModel {
  constructor() {
    this.side = new BitModel([256, 256, 256, LEVELS * 8, 1250]);
    this.tie = new BitModel([COUNTS * LEVELS, 512, COUNTS]);
    this.excess = new BitModel([COUNTS * COUNTS, LEVELS * COUNTS, 64]);
  }

  /** How many of `count` vertices are in the first half. The names are those of the format's description. */
  code(coder, count, level, down, roomFirst, roomSecond, before, after, first, second, beside, cornerBefore, cornerAfter) {
    if (roomFirst === 0) return 0;
    if (roomSecond === 0) return count;
    if (count >= roomFirst + roomSecond) return roomFirst;
    const half = count >> 1;
    level = min(level, LEVELS - 1);
    if (!(count & 1)) {
      const size = min(half, COUNTS - 1);
      at[0] = size * LEVELS + level;
      at[1] = min(before + after, 7) * 64 + pair(first + second, beside, 7);
      at[2] = size;
      if (this.tie.code(coder)) return half;
    }
    const few = min(count, 4) - 1;
    at[0] = few * 64 + pair(before, after, 7);
    at[1] = few * 64 + pair(first, second, 7);
    at[2] = few * 64 + pair(cornerBefore, cornerAfter, 7);
    at[3] = (level * 4 + few) * 2 + down;
    at[4] = pair(before + first, after + second, 24) * 2 + (few > 0 ? 1 : 0);
    const room = clamp(((roughLog(roomFirst) - roughLog(roomSecond)) * 177) >> 7, -600, 600);
    const toFirst = this.side.code(coder, room);
    let larger = half + 1;
    for (let more = 0; larger < count; ++more, ++larger) {
      const counted = min(more, COUNTS - 1);
      at[0] = min(bitWidth(count), COUNTS - 1) * COUNTS + counted;
      at[1] = level * COUNTS + counted;
      at[2] = pair(count, more, 7);
      if (!this.excess.code(coder)) break;
    }
    const taken = toFirst ? larger : count - larger;
    return clamp(taken, max(count - roomSecond, 0), min(count, roomFirst));
  }
}

const cellsOf = (points, level) => (points === 0 ? 0 : ((points - 1) >> level) + 1);
const roomOf = (first, level, points) => clamp(points - first, 0, 1 << level);

/** Decodes points of a grid. Returns x + y * columns of each, in raster order. */
function codePoints(coder, columns, rows, count) {
  const found = new Uint32Array(count);
  if (count === 0) return found;
  const model = new HalvesModel();
  let levelX = 0;
  while (1 << levelX < max(columns, rows)) ++levelX;
  let levelY = levelX, width = 1, height = 1;
  // Counts of the cells, with two rings of empty ones around them.
  let now = new Uint32Array(25);
  now[12] = count;
  while (levelX > 0 || levelY > 0) {
    const down = levelX === levelY, nextX = down ? levelX : levelX - 1, nextY = down ? levelY - 1 : levelY;
    const nextWidth = cellsOf(columns, nextX), nextHeight = cellsOf(rows, nextY);
    const r = width + 4, s = nextWidth + 4;
    const then = new Uint32Array(s * (nextHeight + 4));
    for (let y = 0; y < height; ++y)
      for (let x = 0, i = (y + 2) * r + 2; x < width; ++x, ++i) {
        const here = now[i];
        if (here === 0) continue;
        let inFirst, j, k;
        if (down) {
          j = (2 * y + 2) * s + x + 2;
          k = j + s;
          const wide = roomOf(x << levelX, levelX, columns), top = (2 * y) << nextY;
          inFirst = model.code(coder, here, levelX, 1, wide * roomOf(top, nextY, rows),
            wide * roomOf(top + (1 << nextY), nextY, rows), 2 * then[j - s], now[i + r], then[j - 1], then[k - 1],
            now[i + 1], then[j - s - 1] + then[j - s + 1], (now[i + r - 1] + now[i + r + 1] + 1) >>> 1);
        } else {
          j = (y + 2) * s + 2 * x + 2;
          k = j + 1;
          const high = roomOf(y << levelY, levelY, rows), left = (2 * x) << nextX;
          inFirst = model.code(coder, here, levelX, 0, high * roomOf(left, nextX, columns),
            high * roomOf(left + (1 << nextX), nextX, columns), 2 * then[j - 1], now[i + 1], then[j - s], then[k - s],
            now[i + r], 2 * then[j - s - 1] + now[i + r - 1], 2 * then[k - s + 1] + now[i + r + 1]);
        }
        then[j] = inFirst;
        if (inFirst < here) then[k] = here - inFirst;
      }
    now = then;
    levelX = nextX;
    levelY = nextY;
    width = nextWidth;
    height = nextHeight;
  }
  for (let y = 0, n = 0; y < rows; ++y)
    for (let x = 0; x < columns; ++x) if (now[(y + 2) * (columns + 4) + x + 2]) found[n++] = y * columns + x;
  return found;
}

/** Decodes all points as row * columns + column of the whole grid, in raster order. */
function codeAllPoints(coder, columns, rows, most) {
  const across = columns - 2, down = rows - 2, line = 2 * (across + down);
  const inner = coder.number(7), outer = coder.number(4);
  if (inner > across * down || outer > line || inner + outer > most)
    fail(`says to hold ${inner + outer} vertices, more than its grid or its bytes have room for`);
  const border = codePoints(coder, line, 1, outer), inside = codePoints(coder, across, down, inner);
  const place = new Uint32Array(4 + outer + inner);
  place.set([0, columns - 1, (rows - 1) * columns, rows * columns - 1]);
  let n = 4;
  // Top, right, bottom, left.
  for (let k of border) {
    if (k < across) place[n++] = k + 1;
    else if ((k -= across) < down) place[n++] = (k + 2) * columns - 1;
    else if ((k -= down) < across) place[n++] = (rows - 1) * columns + k + 1;
    else place[n++] = (k - across + 1) * columns;
  }
  for (const k of inside) place[n++] = (floor(k / across) + 1) * columns + (k % across) + 1;
  return place.sort();
}

// ---- A triangulation whose faces change in place

/** Spreads the bits of a number below 2^18 to every second place. */
function spread(n) {
  const half = (x) => {
    x = (x | (x << 8)) & 0x00ff00ff;
    x = (x | (x << 4)) & 0x0f0f0f0f;
    x = (x | (x << 2)) & 0x33333333;
    return (x | (x << 1)) & 0x55555555;
  };
  return half(n >> 12) * 2 ** 24 + half(n & 4095);
}

class Triangulation {
  /** x, y: quarter pixels of each vertex; order: the vertices as they are inserted */
  constructor(x, y, order) {
    const count = x.length;
    this.x = x;
    this.y = y;
    this.size = 2;
    this.corner = new Int32Array(6 * count); // counter-clockwise on screen
    this.across = new Int32Array(6 * count).fill(NONE); // the face beyond the edge opposite each corner
    this.known = new Uint8Array(2 * count);
    this.faceOf = new Int32Array(count); // one of each vertex
    // In raster order the first row and the last one end with corners.
    let topRight = 0, bottomLeft = count - 1;
    while (topRight + 1 < count && y[topRight + 1] === y[0]) ++topRight;
    while (y[bottomLeft - 1] === y[count - 1]) --bottomLeft;
    const corners = [0, bottomLeft, count - 1, topRight];
    this.set(0, 0, bottomLeft, count - 1, NONE, 1, NONE);
    this.set(1, 0, count - 1, topRight, NONE, NONE, 0);
    this.faceOf[topRight] = 1;
    let near = 0;
    for (const v of order) if (!corners.includes(v)) near = this.insert(v, near);
  }

  set(f, a, b, c, acrossA, acrossB, acrossC) {
    const { corner, across } = this, i = 3 * f;
    corner[i] = a;
    corner[i + 1] = b;
    corner[i + 2] = c;
    across[i] = acrossA;
    across[i + 1] = acrossB;
    across[i + 2] = acrossC;
  }

  /** Twice the area: positive if a, b, c run counter-clockwise on screen. */
  area(a, b, c) {
    const { x, y } = this;
    return (y[b] - y[a]) * (x[c] - x[a]) - (x[b] - x[a]) * (y[c] - y[a]);
  }

  /** Whether d lies inside the circle through a, b, c. */
  inCircle(a, b, c, d) {
    const { x, y } = this;
    const ax = x[a] - x[d], ay = y[a] - y[d], bx = x[b] - x[d], by = y[b] - y[d], cx = x[c] - x[d], cy = y[c] - y[d];
    const aa = ax * ax + ay * ay, bb = bx * bx + by * by, cc = cx * cx + cy * cy;
    const bc = bx * cy - by * cx, ca = cx * ay - cy * ax, ab = ax * by - ay * bx;
    const sum = aa * bc + bb * ca + cc * ab;
    // Sums below 2^53 are exact; larger ones are off by less than 2^-50 of their parts.
    const size = aa * abs(bc) + bb * abs(ca) + cc * abs(ab);
    if (size < 2 ** 53 || abs(sum) > size * 2 ** -50) return sum < 0;
    const big = BigInt;
    return big(aa) * big(bc) + big(bb) * big(ca) + big(cc) * big(ab) < 0n;
  }

  /** Which corner of f is v. */
  cornerAt(f, v) {
    const { corner } = this;
    return corner[3 * f] === v ? 0 : corner[3 * f + 1] === v ? 1 : 2;
  }
  /** The face across the edge of f that is opposite its corner v. */
  beyond(f, v) {
    return this.across[3 * f + this.cornerAt(f, v)];
  }
  /** Which corner of f is opposite its edge to g. */
  facing(f, g) {
    const { across } = this;
    return across[3 * f] === g ? 0 : across[3 * f + 1] === g ? 1 : 2;
  }
  /** Which corner of f is opposite its edge that starts at vertex a. */
  opposite(f, a) {
    return before(this.cornerAt(f, a));
  }

  /** The face on the left of the edge from a to b, or NONE beyond the border: sought in both directions in turn. */
  faceAt(a, b) {
    const { corner, across } = this;
    for (let f = this.faceOf[a], g = f; f !== NONE || g !== NONE; ) {
      if (f !== NONE) {
        const i = this.cornerAt(f, a);
        if (corner[3 * f + next(i)] === b) return f;
        f = across[3 * f + next(i)];
      }
      if (g !== NONE) {
        const i = this.cornerAt(g, a);
        if (corner[3 * g + next(i)] === b) return g;
        g = across[3 * g + before(i)];
      }
    }
    return NONE;
  }

  /** Sets f as the face across the edge of g that runs from -> to as g sees it. */
  setAcross(f, g, from, to) {
    const { corner, across } = this;
    if (g !== NONE)
      for (let i = 0; i < 3; ++i)
        if (corner[3 * g + next(i)] === from && corner[3 * g + before(i)] === to) across[3 * g + i] = f;
  }

  insert(v, near) {
    const { corner, across, faceOf } = this;
    // Walks towards the place.
    let f = near, edge = 3;
    for (let found = false; !found; ) {
      found = true;
      edge = 3;
      for (let i = 0; i < 3; ++i) {
        const side = this.area(corner[3 * f + next(i)], corner[3 * f + before(i)], v);
        if (side === 0) edge = i;
        if (side >= 0) continue;
        f = across[3 * f + i];
        found = false;
        break;
      }
    }
    const stack = [];
    const settle = (g) => {
      const a = corner[3 * g + 1], b = corner[3 * g + 2];
      this.setAcross(g, across[3 * g], b, a);
      faceOf[v] = faceOf[a] = faceOf[b] = g;
      stack.push(g);
    };
    const first = edge === 3 ? 0 : edge;
    const o = corner[3 * f + first], a = corner[3 * f + next(first)], b = corner[3 * f + before(first)];
    const atAB = across[3 * f + first], atBO = across[3 * f + next(first)], atOA = across[3 * f + before(first)];
    const g = this.size++;
    if (edge === 3) {
      const h = this.size++;
      this.set(f, v, o, a, atOA, g, h);
      this.set(g, v, a, b, atAB, h, f);
      this.set(h, v, b, o, atBO, f, g);
      settle(f);
      settle(g);
      settle(h);
    } else {
      // v divides the edge (a, b) of (o, a, b); beyond it is (q, b, a).
      this.set(f, v, o, a, atOA, NONE, g);
      this.set(g, v, b, o, atBO, f, NONE);
      if (atAB !== NONE) {
        const e = atAB, j = this.opposite(e, b), q = corner[3 * e + j];
        const atQB = across[3 * e + before(j)], atAQ = across[3 * e + next(j)], h = this.size++;
        this.set(e, v, q, b, atQB, g, h);
        this.set(h, v, a, q, atAQ, e, f);
        across[3 * f + 1] = h;
        across[3 * g + 2] = e;
        settle(e);
        settle(h);
      }
      settle(f);
      settle(g);
    }
    this.legalise(v, stack);
    return faceOf[v];
  }

  /** Flips edges opposite the new vertex until none has a vertex inside its circle. */
  legalise(v, stack) {
    const { corner, across, faceOf } = this;
    while (stack.length > 0) {
      const f = stack.pop(), i = this.cornerAt(f, v), g = across[3 * f + i];
      if (g === NONE) continue;
      const a = corner[3 * f + next(i)], b = corner[3 * f + before(i)], j = this.opposite(g, b), q = corner[3 * g + j];
      if (!this.inCircle(v, a, b, q)) continue;
      const atVA = across[3 * f + before(i)], atBV = across[3 * f + next(i)];
      const atQB = across[3 * g + before(j)], atAQ = across[3 * g + next(j)];
      this.set(f, v, a, q, atAQ, g, atVA);
      this.set(g, v, q, b, atQB, atBV, f);
      this.setAcross(f, atAQ, q, a);
      this.setAcross(g, atBV, v, b);
      faceOf[v] = faceOf[a] = faceOf[q] = f;
      faceOf[b] = g;
      stack.push(f, g);
    }
  }

  /** Triangulates what lies between an edge and a chain of vertices on its left, by Delaunay's rule. */
  fill(chain, from, to, out) {
    if (chain.length === 0) return;
    let best = 0;
    for (let k = 1; k < chain.length; ++k) if (this.inCircle(from, to, chain[best], chain[k])) best = k;
    out.push(from, to, chain[best]);
    this.fill(chain.slice(0, best), from, chain[best], out);
    this.fill(chain.slice(best + 1), chain[best], to, out);
  }

  /** Makes (a, b, c) a known face in place of strip[0]; the strip leads from there to c, and is filled again. */
  fixFace(a, b, c, strip) {
    const { corner, across, faceOf } = this;
    this.known[strip[0]] = 1;
    if (strip.length === 1) {
      faceOf[a] = faceOf[b] = faceOf[c] = strip[0];
      return;
    }
    const sides = [], left = [], right = [];
    strip.forEach((f, k) => {
      for (let i = 0; i < 3; ++i) sides.push(corner[3 * f + next(i)], corner[3 * f + before(i)], across[3 * f + i]);
      if (k + 1 === strip.length) return;
      const dropped = corner[3 * f + this.facing(f, strip[k + 1])];
      const apex = corner[3 * f + (k === 0 ? this.opposite(f, a) : this.facing(f, strip[k - 1]))];
      (dropped === (left.length ? left[left.length - 1] : a) ? left : right).push(apex);
    });
    const filled = [a, b, c];
    this.fill(left, a, c, filled);
    this.fill(right.reverse(), c, b, filled);
    strip.forEach((f, k) => {
      const [p, q, r] = filled.slice(3 * k, 3 * k + 3);
      this.set(f, p, q, r, NONE, NONE, NONE);
      faceOf[p] = faceOf[q] = faceOf[r] = f;
    });
    strip.forEach((f) => {
      for (let i = 0; i < 3; ++i) {
        const from = corner[3 * f + next(i)], to = corner[3 * f + before(i)];
        let g = NONE;
        for (const e of strip)
          for (let j = 0; j < 3; ++j)
            if (g === NONE && corner[3 * e + next(j)] === to && corner[3 * e + before(j)] === from) g = e;
        if (g === NONE) {
          for (let j = 0; j < sides.length; j += 3) if (sides[j] === from && sides[j + 1] === to) g = sides[j + 2];
          this.setAcross(f, g, to, from);
        }
        across[3 * f + i] = g;
      }
    });
  }
}

// ---- Faces, found one by one from the border inwards

const MAX_STEPS = 24, MAX_COTANGENT = 2 ** 20, CLASSES = 13;

/** Classes of a cotangent in 1/256: octaves of its magnitude, 0 to 12. */
function classOf(cotangent) {
  const size = abs(cotangent), level = size < 32 ? 0 : min(6, bitWidth(size) - 5);
  return cotangent < 0 ? 6 - level : 6 + level;
}

/** There is no way on. */
const NO_STEP = { face: NONE };

class FaceCoder {
  constructor(faces) {
    this.faces = faces;
    this.gates = [];
    this.reached = new Uint8Array(faces.x.length);
    this.stop = new BitModel([24 * CLASSES, 12 * (CLASSES + 1), CLASSES * (CLASSES + 1), 8 * CLASSES, 512]);
    this.side = new BitModel([4 * CLASSES, 81, 2 * CLASSES, 256]);
    for (let i = 0; i < 3 * faces.size; ++i) {
      const f = 3 * floor(i / 3), k = i - f;
      if (faces.across[i] === NONE) this.gates.push([faces.corner[f + next(k)], faces.corner[f + before(k)]]);
    }
  }

  code(coder) {
    const { faces, gates, reached } = this;
    while (gates.length > 0) {
      const [a, b] = gates.pop(), first = faces.faceAt(a, b);
      if (first === NONE || faces.known[first]) continue;
      const { apex, strip } = this.walk(coder, a, b, first);
      faces.fixFace(a, b, apex, strip);
      gates.push([a, apex], [apex, b]);
      reached[a] = reached[b] = reached[apex] = 1;
    }
  }

  walk(coder, a, b, first) {
    let step = this.reach(a, b, first, a, b, NONE, NONE), last = step, length = 1;
    const strip = [first];
    this.setGate(a, b, first);
    for (let depth = 0; depth < MAX_STEPS; ++depth) {
      if (step.mayStop) {
        last = step;
        length = strip.length;
      }
      const left = this.ahead(a, b, step, true), right = this.ahead(a, b, step, false);
      const goLeft = left.face !== NONE, goRight = right.face !== NONE;
      if (!goLeft && !goRight) break;
      if (step.mayStop && this.stops(coder, a, b, depth, step, left, right)) break;
      const toLeft = goLeft && goRight ? this.turnsLeft(coder, a, b, depth, step, left, right) : goLeft;
      step = toLeft ? left : right;
      strip.push(step.face);
    }
    strip.length = length;
    return { apex: last.apex, strip };
  }

  cotangent(a, b, c) {
    const { x, y } = this.faces;
    const dot = (x[a] - x[c]) * (x[b] - x[c]) + (y[a] - y[c]) * (y[b] - y[c]);
    return clamp(Math.trunc((dot * 256) / this.faces.area(a, b, c)), -MAX_COTANGENT, MAX_COTANGENT);
  }

  /**
   * A step into a face through the edge from left to right. An apex may be reached if it is lower than what was
   * passed on either side: lowLeft as seen from a, lowRight as seen from b.
   */
  reach(a, b, face, left, right, lowLeft, lowRight) {
    const { faces } = this, { corner } = faces;
    let apex = corner[3 * face];
    for (let i = 1; apex === left || apex === right; ++i) apex = corner[3 * face + i];
    const inFront = faces.area(a, b, apex) > 0;
    const goesLeft = lowLeft === NONE ? inFront : faces.area(a, apex, lowLeft) > 0;
    const goesRight = lowRight === NONE ? inFront : faces.area(apex, b, lowRight) > 0;
    const mayStop = goesLeft && goesRight, cotangent = mayStop ? this.cotangent(a, b, apex) : MAX_COTANGENT;
    return { face, left, right, lowLeft, lowRight, apex, goesLeft, goesRight, mayStop, cotangent };
  }

  ahead(a, b, from, toLeft) {
    if (!(toLeft ? from.goesLeft : from.goesRight)) return NO_STEP;
    const { left, right, apex, lowLeft, lowRight } = from;
    const face = this.faces.beyond(from.face, toLeft ? right : left);
    if (face === NONE || this.faces.known[face]) return NO_STEP;
    return toLeft
      ? this.reach(a, b, face, left, apex, lowLeft, from.goesRight ? apex : lowRight)
      : this.reach(a, b, face, apex, right, from.goesLeft ? apex : lowLeft, lowRight);
  }

  /** Keeps what contexts need of the gate: the vertex behind it, and its squared length. */
  setGate(a, b, first) {
    const { faces } = this, { x, y } = faces;
    const face = faces.beyond(first, faces.corner[3 * first + faces.opposite(first, a)]);
    this.behind = face === NONE ? NONE : faces.corner[3 * face + faces.opposite(face, b)];
    this.edge = (x[a] - x[b]) ** 2 + (y[a] - y[b]) ** 2;
  }

  /** How far c is from completing a parallelogram, in octaves of its square over that of the edge. */
  missOf(a, b, c) {
    const { faces: { x, y }, behind: o } = this;
    if (o === NONE) return 15;
    const miss = (x[a] + x[b] - x[o] - x[c]) ** 2 + (y[a] + y[b] - y[o] - y[c]) ** 2;
    return min(15, bitWidth(divide(miss * 64, this.edge)));
  }

  stops(coder, a, b, depth, step, left, right) {
    const { faces, reached, behind } = this, { apex, cotangent } = step;
    const isKnown = (v) => {
      const g = faces.beyond(step.face, v);
      return g === NONE || faces.known[g] === 1;
    };
    const known = (step.left === a && isKnown(step.right) ? 1 : 0) + (step.right === b && isKnown(step.left) ? 1 : 0);
    const k = min(depth, 3), own = classOf(cotangent);
    const of = (s) => (s.face === NONE ? MAX_COTANGENT : s.cotangent), after = min(of(left), of(right));
    const gap = after === MAX_COTANGENT ? CLASSES : classOf(after - cotangent);
    let flat = CLASSES, other = 15;
    if (behind !== NONE) {
      flat = classOf(cotangent + this.cotangent(b, a, behind));
      if (after !== MAX_COTANGENT)
        other = this.missOf(a, b, left.face !== NONE && after === left.cotangent ? left.apex : right.apex);
    }
    const thin = max(this.cotangent(b, apex, a), this.cotangent(apex, a, b));
    at[0] = ((k * 3 + known) * 2 + reached[apex]) * CLASSES + own;
    at[1] = (k * 3 + known) * (CLASSES + 1) + gap;
    at[2] = own * (CLASSES + 1) + flat;
    at[3] = (classOf(thin) * 4 + k) * 2 + reached[apex];
    at[4] = (this.missOf(a, b, apex) * 16 + other) * 2 + (k > 0 ? 1 : 0);
    return this.stop.code(coder);
  }

  turnsLeft(coder, a, b, depth, step, left, right) {
    const turned = left.cotangent > right.cotangent, first = turned ? right : left, second = turned ? left : right;
    const k = min(depth, 3);
    const kind = (s) =>
      (s.mayStop ? 1 + this.reached[s.apex] : 0) * 3 + (s.goesLeft ? (s.goesRight ? 2 : 1) : 0);
    const lean = this.cotangent(b, step.apex, a) - this.cotangent(step.apex, a, b);
    at[0] = k * CLASSES + classOf(second.cotangent - first.cotangent);
    at[1] = kind(first) * 9 + kind(second);
    at[2] = classOf(turned ? -lean : lean) * 2 + (k > 0 ? 1 : 0);
    at[3] = this.missOf(a, b, first.apex) * 16 + this.missOf(a, b, second.apex);
    return turned !== (this.side.code(coder) === 1);
  }
}

// ---- Colours, in 1/64 of a grey level

// 256 log2(1 + i / 16), and 2^14 2^(-i / 16).
const LOG = [0, 22, 44, 63, 82, 100, 118, 134, 150, 165, 179, 193, 207, 220, 232, 244, 256];
const POWER = [16384, 15689, 15024, 14387, 13777, 13193, 12634, 12098, 11585, 11094, 10624, 10173, 9742, 9329, 8933, 8555, 8192];

/** 256 log2 of a number from 1 to 2^53. */
function log2(number) {
  const whole = bitWidth(number) - 1, twelve = floor(number * 2 ** (12 - whole)), i = (twelve >> 8) & 15, part = twelve & 255;
  return 256 * whole + ((LOG[i] * (256 - part) + LOG[i + 1] * part + 128) >> 8);
}
const log16 = (number) => log2(number) >> 4;

/** 2^14 2^(-t / 1024). */
function halfPower(t) {
  if (t >= 14 * 1024) return 0;
  const i = (t >> 6) & 15, part = t & 63;
  return ((POWER[i] * (64 - part) + POWER[i + 1] * part) >> 6) >> (t >> 10);
}

/** step * 2^(log / 16), times 2^(1/16) */
function halfDistance(step, log) {
  const l = clamp(log, -80, 144) + 80;
  return max(floor(step * halfPower((15 - (l & 15)) * 64) * 2 ** ((l >> 4) - 18)), 1);
}

/** Sorts `order` stably by keys below `size`. */
function sortBy(key, order, size) {
  const first = new Uint32Array(size + 1), out = new Uint32Array(order.length);
  for (const i of order) ++first[key[i] + 1];
  for (let k = 0; k < size; ++k) first[k + 1] += first[k];
  for (const i of order) out[first[key[i]]++] = i;
  return out;
}

const MOST_NEIGHBORS = 12;

/** What the colours are predicted from, and how finely they are coded, by the shape alone. */
function planColors(faces, right, bottom) {
  const { x, y, corner } = faces, count = x.length, edges = 3 * faces.size;
  const later = new Uint32Array(edges), earlier = new Uint32Array(edges), area = new Float64Array(edges);
  const star = new Float64Array(count);
  for (let i = 0; i < edges; ++i) {
    const f = 3 * floor(i / 3), a = corner[i], b = corner[f + next(i - f)];
    area[i] = i === f ? faces.area(a, b, corner[f + 2]) : area[f];
    later[i] = max(a, b);
    earlier[i] = min(a, b);
    star[a] += area[i];
  }
  // By the later vertex, then by the earlier one downwards.
  const order = sortBy(later, sortBy(earlier, Uint32Array.from(later, (_, i) => i), count).reverse(), count);
  const first = new Uint32Array(count + 1), neighbor = new Uint32Array(edges), weight = new Int32Array(edges);
  let n = 0;
  for (let v = 0, i = 0; v < count; ++v) {
    first[v] = n;
    while (i < edges && later[order[i]] === v) {
      const u = earlier[order[i]];
      let both = 0;
      for (; i < edges && later[order[i]] === v && earlier[order[i]] === u; ++i) both += area[order[i]];
      if (n - first[v] === MOST_NEIGHBORS) continue;
      const squared = (x[v] - x[u]) ** 2 + (y[v] - y[u]) ** 2;
      neighbor[n] = u;
      weight[n++] = (18 * log2(squared + 16) + 51 * log2(both + 8) + 22 * log2(star[u] + 8)) >> 6;
    }
    let most = 0;
    for (let k = first[v]; k < n; ++k) most = max(most, weight[k]);
    for (let k = first[v]; k < n; ++k) weight[k] = max(halfPower(4 * (most - weight[k])) >> 2, 1);
  }
  first[count] = n;
  const mean = divide(6 * right * bottom, count);
  const fineness = Int32Array.from(star, (own) =>
    floor(Math.sqrt(4096 * clamp(divide(4096 * mean, max(own, 1)), 455, 36864))));
  return { first, neighbor, weight, fineness };
}

/**
 * By channel: how the distance over which a guess halves follows from the spread, the surprise, the number of
 * neighbours, the fineness and the levels of two channels before; the same around neighbours; the guess's weight and
 * the pull of neighbours.
 */
const SHAPES = [
  [20, 26, 41, -1072, 20, 0, 0, -4, 92, 223],
  [4, 118, 36, -1104, -74, 944, 0, -24, 146, 184],
  [-38, 38, 26, -496, -118, 816, 3776, 1, 303, 205],
];
const LEAST_COLOR = -32768, MOST_COLOR = 32767, ESCAPE = 16, ODDS_BUCKETS = 24, LOG_BUCKETS = 16, NEAR_BUCKETS = 7;

const bucket = (value, first, width, count) => clamp(divide(value - first, width), 0, count - 1);
const oddsBucket = (odds) => bucket(odds, -768, 64, ODDS_BUCKETS);
const logBucket = (log) => bucket(log, -64, 10, LOG_BUCKETS);
const oddsBetween = (yes, no) => clamp(((log2(yes + 1) - log2(no + 1)) * 177) >> 8, -1800, 1800);

class ColorDecoder {
  constructor(plan, channels, steps) {
    const count = plan.fineness.length * channels;
    this.plan = plan;
    this.channels = channels;
    this.steps = steps;
    this.color = new Int32Array(count);
    this.calm = new Int32Array(count); // colours drawn towards what had been expected of them
    this.surprise = new Int32Array(count); // how far they were from that
    this.guessed = [0, 0, 0, 0];
    this.level = [0, 0, 0, 0];
    this.zero = new BitModel([4 * ODDS_BUCKETS, 16 * LOG_BUCKETS, 4 * LOG_BUCKETS * LOG_BUCKETS, 256, 4 * NEAR_BUCKETS], 4);
    this.sign = new BitModel([4 * ODDS_BUCKETS, 4 * NEAR_BUCKETS, 36], 4);
    this.size = new BitModel([16 * ODDS_BUCKETS, ESCAPE * LOG_BUCKETS, ESCAPE * LOG_BUCKETS], 3);
    // The mixture: around which values, over which distances they halve, and what they weigh.
    this.place = new Int32Array(MOST_NEIGHBORS + 1);
    this.half = new Int32Array(MOST_NEIGHBORS + 1);
    this.share = new Int32Array(MOST_NEIGHBORS + 1);
  }

  /** The mean of some values around a vertex: of the sum of f(i) with the plan's weights. */
  mean(vertex, channel, round, f) {
    const { first, neighbor, weight } = this.plan;
    let sum = 0, all = 0;
    for (let k = first[vertex]; k < first[vertex + 1]; ++k) {
      sum += weight[k] * f(neighbor[k] * this.channels + channel);
      all += weight[k];
    }
    return round(sum, all);
  }

  stepOf(vertex, channel) {
    return max((this.steps[channel] * this.plan.fineness[vertex] + 2048) >> 12, 1);
  }

  /** Colour changes with lightness as it does among the neighbours, damped. */
  gainWithLight(vertex, channel, value) {
    const { calm, guessed, channels } = this, light = (i) => calm[i - channel] - guessed[0];
    const both = this.mean(vertex, channel, divide, (i) => light(i) * (calm[i] - value));
    const own = this.mean(vertex, channel, divide, (i) => light(i) ** 2), step = this.stepOf(vertex, 0);
    const variance = own + floor((3 * step * step) / 2) + 1;
    const slope = clamp(rounded(256 * both, variance), -1024, 1024);
    return (slope * (this.color[vertex * channels] - guessed[0]) + 256) >> 9;
  }

  /** The weight of the mixture below a value, times 2^14. */
  below(value) {
    const { place, half, share } = this;
    let sum = 0;
    for (let k = 0; k < this.parts; ++k) {
      const apart = value - place[k], part = halfPower(floor((1024 * abs(apart)) / half[k])) >> 1;
      sum += share[k] * (apart < 0 ? part : (1 << 14) - part);
    }
    return sum;
  }

  /** The weight of what lies farther from 0 than that level does. */
  beyond(level) {
    const half = (this.step + 1) >> 1, middle = this.value + level * this.step;
    return level < 0 ? this.below(middle - half) : this.all - this.below(middle + half);
  }

  guess(vertex, channel) {
    const { plan, channels, color, calm } = this, { first, neighbor, weight } = plan;
    const from = first[vertex], to = first[vertex + 1], step = this.stepOf(vertex, channel);
    let value, spread = 0, surprise = 8 * step;
    this.step = step;
    this.neighbors = to - from;
    this.nearest = 0;
    if (from === to) {
      if (vertex > 0) value = color[(vertex - 1) * channels + channel];
      else if (channel === 0) value = 64 * (channels < 3 ? 128 : 222);
      else value = channels % 2 === 0 && channel === channels - 1 ? 64 * 255 : 0;
    } else {
      value = this.mean(vertex, channel, rounded, (i) => calm[i]);
      if (channels >= 3 && (channel === 1 || channel === 2))
        value = clamp(value + this.gainWithLight(vertex, channel, value), LEAST_COLOR, MOST_COLOR);
      spread = this.mean(vertex, channel, divide, (i) => abs(color[i] - value));
      surprise = this.mean(vertex, channel, rounded, (i) => this.surprise[i]);
      let most = from;
      for (let k = from + 1; k < to; ++k) if (weight[k] > weight[most]) most = k;
      this.nearest = color[neighbor[most] * channels + channel] - value;
    }
    this.value = this.guessed[channel] = value;
    const base = 1 + (step >> 4), stepLog = log16(step);
    this.spread = log16(base + spread) - stepLog;
    this.surprised = log16(base + surprise) - stepLog;
    this.setMixture(vertex, channel);
  }

  setMixture(vertex, channel) {
    const { plan, color, channels, place, half, share, value } = this, { first, neighbor, weight } = plan;
    const shape = SHAPES[min(channel, 2)];
    let sum = shape[1] * this.spread + shape[2] * this.surprised + shape[3] * min(this.neighbors, 5) +
      shape[4] * (log16(plan.fineness[vertex]) - 192);
    for (let i = 0; i < min(channel, 2); ++i) sum += shape[5 + i] * min(abs(this.level[i]), 3);
    const log = shape[0] + (sum >> 8), around = halfDistance(this.step, log + shape[7]);
    let all = 0, n = 1;
    for (let k = first[vertex]; k < first[vertex + 1]; ++k, ++n) {
      all += share[n] = weight[k];
      half[n] = around;
      place[n] = value + (((color[neighbor[k] * channels + channel] - value) * shape[9]) >> 8);
    }
    place[0] = value;
    half[0] = halfDistance(this.step, log);
    share[0] = max((all * shape[8]) >> 8, 1);
    this.parts = n;
    this.all = (all + share[0]) * 2 ** 14;
    this.less = this.below(value - ((this.step + 1) >> 1));
    this.more = this.beyond(0);
  }

  nearBucket() {
    const eighths = divide(8 * this.nearest, this.step), size = abs(eighths);
    const away = size < 2 ? 0 : size < 6 ? 1 : size < 14 ? 2 : 3;
    return eighths < 0 ? 3 - away : 3 + away;
  }

  codeLevel(coder, channel) {
    const { less, more } = this, around = logBucket(this.spread), surprise = logBucket(this.surprised);
    const one = channel > 0 ? this.level[0] : 0, two = channel > 1 ? this.level[1] : 0, near = this.nearBucket();
    let odds = oddsBetween(less + more, this.all - less - more);
    at[0] = channel * ODDS_BUCKETS + oddsBucket(odds);
    at[1] = (channel * LOG_BUCKETS + around) * 4 + clamp(this.neighbors, 1, 4) - 1;
    at[2] = (channel * LOG_BUCKETS + surprise) * LOG_BUCKETS + around;
    at[3] = ((channel * 4 + min(abs(one), 3)) * 4 + min(abs(two), 3)) * 4 + (surprise >> 2);
    at[4] = channel * NEAR_BUCKETS + near;
    if (!this.zero.code(coder, odds, channel)) return 0;
    odds = oddsBetween(less, more);
    at[0] = channel * ODDS_BUCKETS + oddsBucket(odds);
    at[1] = channel * NEAR_BUCKETS + near;
    at[2] = (channel * 3 + Math.sign(one) + 1) * 3 + Math.sign(two) + 1;
    const sign = this.sign.code(coder, odds, channel) ? -1 : 1;
    let atLeast = sign < 0 ? less : more;
    for (let size = 1; size < ESCAPE; ++size) {
      const larger = this.beyond(sign * size), few = min(size, 3);
      odds = oddsBetween(larger, atLeast - larger);
      at[0] = (few * 4 + channel) * ODDS_BUCKETS + oddsBucket(odds);
      at[1] = size * LOG_BUCKETS + around;
      at[2] = size * LOG_BUCKETS + surprise;
      if (!this.size.code(coder, odds, few - 1)) return sign * size;
      atLeast = larger;
    }
    return sign * (ESCAPE + min(coder.number(0), 2 ** 16));
  }

  code(coder, vertex, channel) {
    this.guess(vertex, channel);
    const level = this.codeLevel(coder, channel), i = vertex * this.channels + channel;
    const color = clamp(this.value + this.step * level, LEAST_COLOR, MOST_COLOR);
    const off = this.neighbors === 0 ? 0 : color - this.value;
    this.color[i] = color;
    this.calm[i] = color - ((off * (channel === 0 ? 3 : 4) + 8) >> 4);
    this.surprise[i] = abs(off);
    this.level[channel] = level;
  }
}

/** Takes channels of lightness and colour to red, green and blue. */
function toRgb(color, channels) {
  for (let i = 0; i < color.length; i += channels) {
    const light = 9459 * color[i] + 8192, across = 11585 * color[i + 1], along = 6689 * color[i + 2];
    color[i + 1] = (light - 13377 * color[i + 2]) >> 14;
    color[i] = (light + across + along) >> 14;
    color[i + 2] = (light - across + along) >> 14;
  }
}

// ---- A stream

function readMesh(bytes) {
  const { width, height, channels, at: start } = readHeader(bytes);
  const coder = new RangeDecoder(bytes, start);
  const step = min(coder.number(2), 4 * MAX_SIDE) + 1, right = 4 * max(width - 1, 1), bottom = 4 * max(height - 1, 1);
  const columns = floor((right + step - 1) / step) + 1, rows = floor((bottom + step - 1) / step) + 1;
  if (columns * rows > MAX_PIXELS) fail(`has a grid of ${columns} x ${rows} points, more than ${MAX_PIXELS}`);
  const steps = [];
  for (let k = 0, base = 0; k < channels; ++k) {
    const index = k === 0 ? (base = coder.bits(8)) : base - 8 + coder.bits(5);
    if (index < 0 || index > 143) fail(`has a colour step of index ${index}, not 0 to 143`);
    steps.push((16 + (index & 15)) << (index >> 4));
  }
  const points = codeAllPoints(coder, columns, rows, 8 * bytes.length);
  coder.checkEnd();
  const x = Int32Array.from(points, (p) => min((p % columns) * step, right));
  const y = Int32Array.from(points, (p) => min(floor(p / columns) * step, bottom));
  const curve = Float64Array.from(points, (p) => 2 * spread(floor(p / columns)) + spread(p % columns));
  const faces = new Triangulation(x, y, Uint32Array.from(points, (_, v) => v).sort((v, w) => curve[v] - curve[w]));
  new FaceCoder(faces).code(coder);
  coder.checkEnd();
  const colors = new ColorDecoder(planColors(faces, right, bottom), channels, steps);
  for (let v = 0; v < points.length; ++v) for (let k = 0; k < channels; ++k) colors.code(coder, v, k);
  coder.checkEnd();
  if (coder.at < bytes.length) fail(`has ${bytes.length - coder.at} bytes after its end`);
  if (channels > 2) toRgb(colors.color, channels);
  return { width, height, channels, x, y, right, bottom, corner: faces.corner, faces: faces.size, color: colors.color };
}

// ---- Drawing: vertices lie on 1/16 of a pixel, colours of pixels are in 1/2^16 of a grey level

const SUB = 16, TO_PIXEL = 1024;

/** A vertex on a side of the picture, on one of the drawing. The outermost half pixels belong to the border. */
function placeOf(at, last, from, to) {
  const out = divide(8 * (at + 2) * to + from, 2 * from) - SUB / 2;
  return at === 0 ? min(out, 0) : at === last ? max(out, SUB * (to - 1)) : out;
}

/** Draws RGBA. Each face is linear in its colours; a later one overwrites. */
function draw(mesh, width, height) {
  const { channels, color, corner } = mesh, data = new Uint8ClampedArray(4 * width * height);
  const px = mesh.x.map((at) => placeOf(at, mesh.right, mesh.width, width));
  const py = mesh.y.map((at) => placeOf(at, mesh.bottom, mesh.height, height));
  const hasAlpha = channels % 2 === 0, source = channels < 3 ? [0, 0, 0, 1] : [0, 1, 2, 3];
  // At one pixel the colour, and what it gains to the right and down; opaque without alpha.
  const here = [0, 0, 0, 255 * 65536], right = [0, 0, 0, 0], down = [0, 0, 0, 0];
  for (let f = 0; f < 3 * mesh.faces; f += 3) {
    let a = corner[f], b = corner[f + 1], c = corner[f + 2];
    let area = (px[b] - px[a]) * (py[c] - py[a]) - (py[b] - py[a]) * (px[c] - px[a]);
    if (area === 0) continue;
    if (area < 0) {
      [b, c] = [c, b];
      area = -area;
    }
    const ax = px[a], ay = py[a], ux = px[b] - ax, uy = py[b] - ay, vx = px[c] - ax, vy = py[c] - ay;
    const top = max((min(ay, py[b], py[c]) + SUB - 1) >> 4, 0), bottom = min(max(ay, py[b], py[c]) >> 4, height - 1);
    let placedX = NONE, placedY = 0;
    for (let y = top; y <= bottom; ++y) {
      let from = 0, to = width - 1;
      for (let i = 0; i < 3; ++i) {
        const p = i === 0 ? a : i === 1 ? b : c, q = i === 0 ? b : i === 1 ? c : a, rise = py[q] - py[p];
        const rest = (px[q] - px[p]) * (SUB * y - py[p]) + rise * px[p];
        if (rise < 0) from = max(from, -divide(rest, -SUB * rise));
        else if (rise > 0) to = min(to, divide(rest, SUB * rise));
      }
      if (from > to) continue;
      if (placedX === NONE) {
        placedX = from;
        placedY = y;
        const wx = SUB * from - ax, wy = SUB * y - ay, weight1 = wx * vy - wy * vx, weight2 = ux * wy - uy * wx;
        const slope = (rise) => divide(SUB * TO_PIXEL * rise + floor(area / 2), area) | 0;
        for (let k = hasAlpha ? 3 : 2; k >= 0; --k) {
          const s = source[k], base = color[a * channels + s];
          const d1 = color[b * channels + s] - base, d2 = color[c * channels + s] - base;
          const above = weight1 * d1 + weight2 * d2, whole = divide(above, area);
          here[k] = (base + whole) * TO_PIXEL + rounded(TO_PIXEL * (above - whole * area), area);
          right[k] = slope(d1 * vy - d2 * uy);
          down[k] = slope(d2 * ux - d1 * vx);
        }
      }
      const stepsX = from - placedX, stepsY = y - placedY;
      const [dr, dg, db, da] = right;
      let [red, green, blue, alpha] = here.map((value, k) => (value + right[k] * stepsX + down[k] * stepsY) | 0);
      for (let i = 4 * (y * width + from), end = 4 * (y * width + to); i <= end; i += 4) {
        const opacity = clamp((alpha + 32768) >> 16, 0, 255);
        if (opacity === 255) {
          data[i] = (red + 32768) >> 16;
          data[i + 1] = (green + 32768) >> 16;
          data[i + 2] = (blue + 32768) >> 16;
        } else {
          const half = floor(alpha / 2), level = (value) => (opacity === 0 ? 0 : divide(255 * value + half, alpha));
          data[i] = level(red);
          data[i + 1] = level(green);
          data[i + 2] = level(blue);
        }
        data[i + 3] = opacity;
        red = (red + dr) | 0;
        green = (green + dg) | 0;
        blue = (blue + db) | 0;
        alpha = (alpha + da) | 0;
      }
    }
  }
  return data;
}

// ---- What others call

const bytesOf = (bytes) => (bytes instanceof Uint8Array ? bytes : new Uint8Array(bytes));

/**
 * What a file says of its picture, from its first bytes.
 * @param {Uint8Array | ArrayBuffer} bytes
 * @returns {Info}
 * @throws {Error} if it is none
 */
export function info(bytes) {
  const { width, height, channels } = readHeader(bytesOf(bytes));
  return { width, height, channels };
}

/**
 * Decodes and draws a file, at any size.
 * @param {Uint8Array | ArrayBuffer} bytes
 * @param {Size} [size]
 * @returns {Picture}
 * @throws {Error} if the bytes are no such file, or the drawing would be larger than 65535 a side or 2^26 pixels
 */
export function decode(bytes, { width, height, scale = 1 } = {}) {
  const mesh = readMesh(bytesOf(bytes)), whole = (x) => max(1, Math.round(x));
  if (width === undefined && height !== undefined) scale = height / mesh.height;
  if (height === undefined && width !== undefined) scale = width / mesh.width;
  width = whole(width ?? mesh.width * scale);
  height = whole(height ?? mesh.height * scale);
  if (!(width <= MAX_SIDE && height <= MAX_SIDE && width * height <= MAX_PIXELS))
    fail(`cannot be drawn at ${width} x ${height} pixels: at most ${MAX_SIDE} a side and ${MAX_PIXELS} in all`);
  // One column of a picture that has only one is drawn, and repeated.
  const columns = mesh.width === 1 ? 1 : width, rows = mesh.height === 1 ? 1 : height;
  let data = draw(mesh, columns, rows);
  if (columns !== width || rows !== height) {
    const pixels = new Uint32Array(data.buffer), all = new Uint32Array(width * height);
    for (let y = 0, i = 0; y < height; ++y)
      for (let x = 0; x < width; ++x) all[i++] = pixels[min(y, rows - 1) * columns + min(x, columns - 1)];
    data = new Uint8ClampedArray(all.buffer);
  }
  return { width, height, channels: mesh.channels, data };
}

/**
 * Draws a file to a canvas, which gets the size of the drawing.
 * @param {HTMLCanvasElement | OffscreenCanvas} canvas
 * @param {Uint8Array | ArrayBuffer} bytes
 * @param {Size} [size]
 * @returns {Picture}
 */
export function drawTo(canvas, bytes, size) {
  const picture = decode(bytes, size);
  canvas.width = picture.width;
  canvas.height = picture.height;
  canvas.getContext("2d").putImageData(new ImageData(picture.data, picture.width, picture.height), 0, 0);
  return picture;
}
