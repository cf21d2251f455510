// Decodes coded pictures (.imgm) in browsers, workers and Node. It needs no other file:
//
//     import { decode, drawTo, info } from "./imgm.js";
//     drawTo(document.querySelector("canvas"), bytes);
//
// It draws the same bytes as imgmesh-decode. docs/codec-format.md explains each step, by the same names. All numbers are
// whole and below 2^53. State is in variables of functions rather than in objects, so that minified code is small.

/**
 * @typedef {{ width: number, height: number, channels: number }} Info  channels: 1 grey, 2 grey and alpha, 3 RGB,
 *     4 RGBA
 * @typedef {{ width?: number, height?: number, scale?: number }} Size  pixels of the drawing; one side follows from
 *     the other; without any, the picture's own size times the scale
 * @typedef {Info & { data: Uint8ClampedArray }} Picture  data: RGBA, rows from the top, alpha not premultiplied
 */

const MAX_PIXELS = 2 ** 26, MAX_SIDE = 65535, NONE = -1;

const { abs, ceil, clz32, floor, max, min, sign } = Math;
const clamp = (x, low, high) => max(low, min(x, high));
const within = (x, most) => clamp(x, -most, most);
// Exact for |a| < 2^52.
const divide = (a, b) => floor(a / b);
const rounded = (a, b) => divide(2 * a + b, 2 * b);
const ints = (count) => new Int32Array(count);
const cross = (ux, uy, vx, vy) => ux * vy - uy * vx;
const squared = (x, y) => x * x + y * y;
/** How many bits a number below 2^32 takes. */
const bitWidth = (x) => 32 - clz32(x);

const fail = (text) => {
  throw new Error(`The coded picture ${text}.`);
};
const damaged = () => fail("is damaged");
const checkSize = (width, height) => {
  if (!(width <= MAX_SIDE && height <= MAX_SIDE && width * height <= MAX_PIXELS)) fail("is too large");
};

// ---- Header

const readHeader = (bytes) => {
  let at = 4;
  const side = () => {
    let number = 0;
    for (let shift = 0; shift < 21; shift += 7) {
      const byte = bytes[at++]; // undefined beyond the end: neither below 128
      number |= (byte & 127) << shift;
      if (byte < 128) return number + 1;
    }
    return damaged();
  };
  if (bytes[0] !== 0x9a || bytes[1] !== 0x49 || bytes[2] !== 0x4d) fail("is none");
  if (bytes[3] >> 2 !== 4) fail("has an unknown version");
  const width = side(), height = side();
  checkSize(width, height);
  return [width, height, (bytes[3] & 3) + 1, at];
};

// ---- Bit models

const MAX_ODDS = 2047, EVEN = 1 << 14;
/** A table of f(0), f(1), ..., rounded: no value is so near to a half that an engine's functions could matter. */
const table = (count, f) => ints(count).map((_, i) => Math.round(f(i)));
const LOGISTIC = table(33, (i) => 65536 / (1 + Math.exp(8 - i / 2)));
/** The probability of log odds in 1/256 (from -MAX_ODDS), in 1/2^16. */
const PROBABILITY = table(2 * MAX_ODDS + 1, (i) => {
  const part = ++i & 127, k = i >> 7;
  return (LOGISTIC[k] * (128 - part) + LOGISTIC[k + 1] * part + 64) >> 7;
});
/** The log odds of a probability in 1/2^12. */
const ODDS = ints(4096);
for (let p = 0, odds = -MAX_ODDS; p < 4096; ODDS[p++] = odds)
  while (odds < MAX_ODDS && PROBABILITY[odds + MAX_ODDS] < 16 * p + 8) ++odds;

/** How fast a context learns that has seen so many bits, in 1/2^15. */
const RATE = ints(251).map((_, seen) => 327680 / (10 * seen + 25));

/** The log odds of a decision's contexts. */
const odds = ints(6);

/**
 * A range decoder. end() fails if the bytes ended too early, or go on. model(sizes, sets) makes a kind of decision with
 * so many contexts of each input; it returns a function that decodes a bit, given the log odds that are expected before
 * anything was seen, the set of weights, and a context of each input.
 */
const rangeDecoder = (bytes, at) => {
  let range = 2 ** 32 - 1, value = 0;
  // Bytes beyond the end count as 0x55.
  const shift = () => (value = ((value << 8) | (bytes[at++] ?? 85)) >>> 0);
  for (let i = 0; i < 4; ++i) shift();

  /** A bit that is 1 with a probability in 1/2^15. */
  const bit = (probability) => {
    const bound = (range >>> 15) * probability, isOne = value < bound;
    if (isOne) range = bound;
    else {
      value -= bound;
      range -= bound;
    }
    for (; range < 2 ** 24; shift()) range *= 256;
    return +isOne;
  };
  const bits = (count) => {
    let number = 0;
    while (count-- > 0) number = 2 * number + bit(EVEN);
    return number;
  };
  /** An exponential Golomb code. */
  const number = (order) => {
    let count = 0;
    while (count < 31 - order && bit(EVEN)) ++count;
    return (2 ** count + bits(count) - 1) * 2 ** order + bits(order);
  };
  const end = (last) => {
    if (at > bytes.length + 4 || (last && at < bytes.length)) damaged();
  };

  const model = (sizes, sets = 1) => {
    const inputs = sizes.length;
    let all = 0;
    const first = sizes.map((size) => (all += size) - size);
    const probability = ints(all).fill(32768), seen = ints(all), settled = ints(sets);
    const weight = ints(sets * (inputs + 1)).map((_, i) => (++i % (inputs + 1) ? floor(9830 / inputs) : 16384));
    return (prior, set, ...context) => {
      const from = set * (inputs + 1);
      let sum = 0;
      odds[inputs] = prior;
      for (let i = 0; i <= inputs; ++i) {
        if (i < inputs) odds[i] = ODDS[probability[(context[i] += first[i])] >> 4];
        sum += weight[from + i] * odds[i];
      }
      const mixed = PROBABILITY[within(sum >> 14, MAX_ODDS) + MAX_ODDS];
      const out = bit(clamp(mixed >> 1, 16, 32752)), target = out * 65535, slower = settled[set] < 500 ? 16 : 17;
      settled[set] += 17 - slower;
      for (let i = 0; i <= inputs; ++i) {
        const w = from + i, k = context[i];
        weight[w] = within(weight[w] + ((odds[i] * (target - mixed) + (1 << (slower - 1))) >> slower), 65536);
        if (i < inputs) {
          probability[k] += ((target - probability[k]) * RATE[seen[k]]) >> 15;
          if (seen[k] < 250) ++seen[k];
        }
      }
      return out;
    };
  };
  return [model, bits, number, end];
};

// ---- Points: counts of vertices in cells that halve until each is one point of the grid

const pair = (a, b, most) => min(a, most) * (most + 1) + min(b, most);
const lead = (a, b) => min(a, 7) - min(b, 7);
const capped = (number) => min(number, 15);
const roomOf = (cell, level, points) => clamp(points - (cell << level), 0, 1 << level);
/** 128 log2, by its first bits. */
const roughLog = (n) => {
  const whole = bitWidth(n) - 1;
  return whole * 128 + (whole < 7 ? n << (7 - whole) : n >> (whole - 7)) - 128;
};

/** Decodes points of a grid. Returns row * columns + column of each, in raster order. */
const codePoints = (model, columns, rows, count) => {
  const found = [], side = model([256, 256, 256, 192, 1250]), tie = model([384, 512, 16]), excess = model([256, 384, 64]);
  if (!count) return found;
  let levelX = bitWidth(max(columns, rows) - 1), levelY = levelX, width = 1, height = 1;
  // Counts of the cells, with two rings of empty ones around them.
  let now = ints(25);
  now[12] = count;
  while (levelX + levelY > 0) {
    const down = +(levelX === levelY), level = min(levelX, 23), nextX = levelX - 1 + down, nextY = levelY - down;
    const nextWidth = ceil(columns / (1 << nextX)), nextHeight = ceil(rows / (1 << nextY)), s = width + 4, t = nextWidth + 4;
    const next = ints(t * (nextHeight + 4));
    // Steps from half to half and aside from them, among the cells and among the halves.
    const [onCell, onHalf, byCell, byHalf] = down ? [s, t, 1, 1] : [1, 1, s, t];

    /** How many of `here` vertices are in the first half j of cell i; the second half is k. */
    const firstOf = (here, i, j, k, roomFirst, roomSecond) => {
      if (!roomFirst || !roomSecond || here >= roomFirst + roomSecond) return min(here, roomFirst);
      const before = 2 * next[j - onHalf], after = now[i + onCell], beside = now[i + byCell];
      const first = next[j - byHalf], second = next[k - byHalf], half = here >> 1, few = min(here, 4) - 1;
      if (here % 2 < 1 && tie([-38, -168, -247, -449][min(half, 4) - 1] + (level < 2 ? 255 : level < 3 ? 79 : 0), 0,
        capped(half) * 24 + level, min(before + after, 7) * 64 + pair(first + second, beside, 7), capped(half)))
        return half;
      const corner = next[j - onHalf - byHalf];
      const [corner1, corner2] = down
        ? [corner + next[j - onHalf + byHalf], (now[i + onCell - byCell] + now[i + onCell + byCell] + 1) >> 1]
        : [2 * corner + now[i - onCell + byCell], 2 * next[k + onHalf - byHalf] + now[i + onCell + byCell]];
      const prior = within(((roughLog(roomFirst) - roughLog(roomSecond)) * 177) >> 7, 600) + 14 * lead(before, after) +
        21 * lead(first, second) + 13 * lead(corner1, corner2);
      const isFirst = side(prior, 0, few * 64 + pair(before, after, 7), few * 64 + pair(first, second, 7),
        few * 64 + pair(corner1, corner2, 7), (level * 4 + few) * 2 + down, pair(before + first, after + second,
          24) * 2 + min(few, 1));
      let more = 0;
      while (half + 1 + more < here &&
        excess(0, 0, capped(bitWidth(here)) * 16 + capped(more), level * 16 + capped(more), pair(here, more, 7)))
        ++more;
      more += half + 1;
      return clamp(isFirst ? more : here - more, max(here - roomSecond, 0), min(here, roomFirst));
    };

    for (let y = 0; y < height; ++y)
      for (let x = 0; x < width; ++x) {
        const i = (y + 2) * s + x + 2, here = now[i];
        if (!here) continue;
        const j = ((y << down) + 2) * t + (x << (1 - down)) + 2, k = j + onHalf;
        const room = down ? roomOf(x, levelX, columns) : roomOf(y, levelY, rows);
        const cell = 2 * (down ? y : x), level = down ? nextY : nextX, points = down ? rows : columns;
        next[j] = firstOf(here, i, j, k, room * roomOf(cell, level, points), room * roomOf(cell + 1, level, points));
        next[k] += here - next[j];
      }
    now = next;
    levelX = nextX;
    levelY = nextY;
    width = nextWidth;
    height = nextHeight;
  }
  for (let y = 0; y < rows; ++y)
    for (let x = 0; x < columns; ++x) if (now[(y + 2) * (columns + 4) + x + 2]) found.push(y * columns + x);
  return found;
};

// ---- Faces. Half-edge e = 3 f + i is the edge of face f opposite its corner i, from corner[after(e)] to
// corner[ahead(e)], counter-clockwise on screen; twin[e] is the same edge of the face beyond it.

const faceOf = (e) => floor(e / 3);
const after = (e) => (e % 3 > 1 ? e - 2 : e + 1);
const ahead = (e) => (e % 3 ? e - 1 : e + 2);

const MAX_COTANGENT = 2 ** 20, CLASSES = 13;

/** Classes of a cotangent in 1/256: octaves of its magnitude, 0 to 12. */
const classOf = (cotangent) => {
  const level = clamp(bitWidth(abs(cotangent)) - 5, 0, 6);
  return cotangent < 0 ? 6 - level : 6 + level;
};

/** Decodes the faces of vertices at (x, y). Returns three corners of each. */
const codeFaces = (model, x, y, order) => {
  const count = x.length, corner = ints(6 * count), twin = ints(9 * count).fill(NONE);
  let size = 2;

  /** Twice the area: positive if a, b, c run counter-clockwise on screen. */
  const area = (a, b, c) => cross(x[c] - x[a], y[c] - y[a], x[b] - x[a], y[b] - y[a]);
  /** Whether d lies inside the circle through a, b, c. */
  const inCircle = (a, b, c, d) => {
    const ax = x[a] - x[d], ay = y[a] - y[d], bx = x[b] - x[d], by = y[b] - y[d], cx = x[c] - x[d], cy = y[c] - y[d];
    const aa = squared(ax, ay), bb = squared(bx, by), cc = squared(cx, cy);
    const bc = cross(bx, by, cx, cy), ca = cross(cx, cy, ax, ay), ab = cross(ax, ay, bx, by), sum = aa * bc +
      bb * ca + cc * ab;
    // Sums of parts below 2^53 are exact.
    const size = aa * abs(bc) + bb * abs(ca) + cc * abs(ab), big = BigInt;
    return (size < 2 ** 53 ? sum : big(aa) * big(bc) + big(bb) * big(ca) + big(cc) * big(ab)) < 0;
  };
  const first = (e) => corner[after(e)], last = (e) => corner[ahead(e)];
  const link = (e, t) => {
    twin[e] = t;
    if (t >= 0) twin[t] = e;
  };
  /** Sets the corners of a face, and what is beyond the edge from b to c. */
  const setFace = (f, a, b, c, beyond) => {
    corner[3 * f] = a;
    corner[3 * f + 1] = b;
    corner[3 * f + 2] = c;
    link(3 * f, beyond);
  };

  // The Delaunay triangulation, vertex by vertex. In raster order the first row and the last one end with corners.
  const right = y.lastIndexOf(y[0]), left = y.indexOf(y[count - 1]);
  let near = 0;
  setFace(0, 0, left, count - 1, NONE);
  setFace(1, 0, count - 1, right, NONE);
  link(1, 5);
  for (const v of order) {
    if (!v || v === left || v === right || v === count - 1) continue;
    // Walks towards the place. edge: on which it lies
    let f = near, edge = NONE;
    for (let i = 0; i < 3; ++i) {
      const e = 3 * f + i, side = area(first(e), last(e), v);
      if (!side) edge = e;
      if (side < 0) {
        f = faceOf(twin[e]);
        edge = i = NONE;
      }
    }
    // The face becomes three, but for one without area if v lies on its edge (a, b).
    const isOnEdge = edge >= 0, e = isOnEdge ? edge : 3 * f, o = corner[e], a = first(e), b = last(e), t = twin[e];
    const g = size + isOnEdge, h = size + !isOnEdge, stack = [f, g, h], atOA = twin[ahead(e)], atBO = twin[after(e)];
    /** Flips the edge opposite v in face f. */
    const flip = (f) => {
      const e = 3 * f, t = twin[e], g = faceOf(t), a = corner[e + 1], b = corner[e + 2], q = corner[t],
        atAQ = twin[after(t)];
      const atQB = twin[ahead(t)], atBV = twin[e + 1];
      setFace(f, v, a, q, atAQ);
      setFace(g, v, q, b, atQB);
      link(3 * g + 1, atBV);
      link(e + 1, 3 * g + 2);
      return g;
    };
    ++size;
    setFace(f, v, o, a, atOA);
    setFace(h, v, b, o, atBO);
    link(3 * h + 1, 3 * f + 2);
    if (isOnEdge && t < 0) {
      twin[3 * f + 1] = NONE;
      stack.splice(1, 1);
    } else {
      ++size;
      setFace(g, v, a, b, t);
      link(3 * f + 1, 3 * g + 2);
      link(3 * g + 1, 3 * h + 2);
      if (isOnEdge) stack.splice(0, 2, flip(g), g, f);
    }
    near = h;
    // Flips edges until none has a vertex inside its circle.
    while ((f = stack.pop()) >= 0) {
      const t = twin[3 * f];
      if (t < 0 || !inCircle(v, corner[3 * f + 1], corner[3 * f + 2], corner[t])) continue;
      stack.push(f, flip(f));
      near = f;
    }
  }

  // Gates are half-edges of known faces. What lies beyond the border counts as known.
  const known = ints(3 * count), reached = ints(count), gates = [], outside = 3 * size;
  for (let e = 0, t = outside; e < outside; ++e)
    if (twin[e] < 0) {
      known[faceOf(t)] = 1;
      gates.push(t);
      link(e, t++);
    }
  const stop = model([312, 168, 182, 104, 512]);
  const turn = model([52, 81, 26, 256]);

  /** Of the angle at c, in 1/256. */
  const cotangent = (a, b, c) => {
    const dot = (x[a] - x[c]) * (x[b] - x[c]) + (y[a] - y[c]) * (y[b] - y[c]), size = area(a, b, c);
    return size > 0 ? within(Math.trunc((dot * 256) / size), MAX_COTANGENT) : MAX_COTANGENT;
  };

  /**
   * Triangulates what lies between an edge and a part of the chain on its left, in the faces that are free: by Delaunay's
   * rule, unless the apex is given. outer: the half-edges beyond the chain. Returns the half-edge from -> to.
   */
  let free, chain, outer;
  const fill = (start, end, from, to, best = NONE) => {
    if (start === end) return outer[start];
    if (best < 0) {
      best = start;
      for (let k = start; ++k < end; ) if (inCircle(from, to, chain[best], chain[k])) best = k;
    }
    const f = faceOf(free.pop()), v = chain[best];
    link(3 * f + 1, fill(start, best, from, v));
    setFace(f, from, to, v, fill(best + 1, end, v, to));
    return 3 * f + 2;
  };

  let a, b, behind;
  const isKnown = (e) => known[faceOf(twin[e])];
  /** A step into a face through a half-edge. Apexes must be lower than those passed, seen from a and from b. */
  const reach = (e, lowLeft, lowRight) => {
    const apex = corner[e], inFront = area(a, b, apex) > 0;
    const goesLeft = lowLeft < 0 ? inFront : area(a, apex, lowLeft) > 0;
    const goesRight = lowRight < 0 ? inFront : area(apex, b, lowRight) > 0, mayStop = inFront && goesLeft && goesRight;
    return !known[faceOf(e)] && {
      e_: e, apex_: apex, lowLeft_: lowLeft, lowRight_: lowRight, goesLeft_: goesLeft, goesRight_: goesRight,
        mayStop_: mayStop,
      angle_: mayStop ? cotangent(a, b, apex) : MAX_COTANGENT,
    };
  };
  /** How far c is from completing a parallelogram, in octaves of its square over that of the edge. */
  const missOf = (c) =>
    behind < 0 ? 15 : bitWidth(min(32767, divide(
      64 * squared(x[a] + x[b] - x[behind] - x[c], y[a] + y[b] - y[behind] - y[c]), squared(x[a] - x[b], y[a] - y[b]))));

  let gate;
  while ((gate = gates.pop()) >= 0) {
    let start = twin[gate];
    if (isKnown(gate)) continue;
    a = first(start);
    b = last(start);
    behind = gate < outside ? corner[gate] : NONE;

    let step = reach(start, NONE, NONE), length = 1;
    const strip = [start];
    for (let depth = 0; depth < 256; ++depth) {
      const { e_: e, apex_: apex, lowLeft_: lowLeft, lowRight_: lowRight, goesLeft_: onLeft, goesRight_: onRight,
        mayStop_: mayStop, angle_: angle } = step, k = min(depth, 3), later = min(k, 1);
      if (mayStop) length = strip.length;
      const left = onLeft && reach(twin[ahead(e)], lowLeft, onRight ? apex : lowRight);
      const right = onRight && reach(twin[after(e)], onLeft ? apex : lowLeft, lowRight);
      if (!left && !right) break;
      const atA = cotangent(b, apex, a), atB = cotangent(apex, a, b);
      if (mayStop) {
        const sides = (first(e) === a && isKnown(ahead(e))) + (last(e) === b && isKnown(after(e)));
        const next = min(left ? left.angle_ : MAX_COTANGENT, right ? right.angle_ : MAX_COTANGENT),
          isLast = next === MAX_COTANGENT;
        const gap = isLast ? CLASSES : classOf(next - angle), own = classOf(angle), thin = classOf(max(atA, atB));
        const miss = missOf(apex), other = isLast ? 15 : missOf((next === left.angle_ ? left : right).apex_);
        const flat = behind < 0 ? CLASSES : classOf(angle + cotangent(b, a, behind)), isReached = reached[apex];
        const prior = -221 - [0, 110, 93, 69][k] + 236 * sides - 53 * isReached - 13 * (own - 6) +
          (isLast ? 424 : 8 * (gap - 6)) +
          44 * (thin - 6) + (behind < 0 ? 156 : 24 * (flat - 6) + (isLast ? 0 : 16 * (other - miss)));
        if (stop(prior, 0, ((k * 3 + sides) * 2 + isReached) * CLASSES + own, (k * 3 + sides) * (CLASSES + 1) + gap,
          own * (CLASSES + 1) + flat, (thin * 4 + k) * 2 + isReached, (miss * 16 + other) * 2 + later))
          break;
      }
      let goesLeft = left;
      if (left && right) {
        const turned = left.angle_ > right.angle_, [one, two] = turned ? [right, left] : [left, right];
        const kind = (s) => (s.mayStop_ ? 3 + 3 * reached[s.apex_] : 0) + (s.goesLeft_ ? 1 + s.goesRight_ : 0);
        const miss = missOf(one.apex_), other = missOf(two.apex_);
        goesLeft = turned != turn(189 - 84 * later + 394 * one.mayStop_ - 555 * two.mayStop_ + 22 * (other - miss), 0,
          k * CLASSES + classOf(two.angle_ - one.angle_), kind(one) * 9 + kind(two),
          classOf(turned ? atB - atA : atA - atB) * 2 + later, miss * 16 + other);
      }
      step = goesLeft ? left : right;
      strip.push(step.e_);
    }

    // The face from a and b to the last apex where the walk might stop takes the place of the strip's first one.
    strip.length = length;
    const c = corner[strip[length - 1]];
    if (length > 1) {
      // The chain from a to b around the strip, on the left of the apex and on its right.
      const faces = strip.map(faceOf), beyond = (e) => (faces.includes(faceOf(twin[e])) ? NONE : twin[e]);
      let apex = 0;
      chain = [];
      outer = [];
      strip.forEach((e, i) => {
        const dropped = corner[twin[strip[i + 1]]]; // undefined at the last one
        if (dropped !== first(e)) outer.splice(apex, 0, beyond(after(e)));
        if (dropped !== last(e)) outer.splice(apex, 0, beyond(ahead(e)));
        chain.splice(dropped === first(e) ? apex++ : apex, 0, corner[e]);
      });
      free = strip.reverse();
      start = fill(0, length, a, b, apex);
      link(start, gate);
      // A strip that curls around a vertex borders on itself.
      const edges = faces.flatMap((f) => [3 * f, 3 * f + 1, 3 * f + 2]);
      for (const e of edges) if (twin[e] < 0) link(e, edges.find((d) => first(d) === last(e) && last(d) === first(e)));
    }
    known[faceOf(start)] = reached[a] = reached[b] = reached[c] = 1;
    // From a to the apex, and on to b.
    gates.push(ahead(start), after(start));
  }
  return [corner.subarray(0, 3 * size), area];
};

// ---- Colours, in 1/64 of a grey level

const LOG = table(17, (i) => 256 * Math.log2(1 + i / 16)), POWER = table(17, (i) => 2 ** (14 - i / 16));

/** 256 log2 of a number from 1 to 2^46: of its first 13 bits. */
const log2 = (number) => {
  if (number >= 2 ** 30) return 4096 + log2(floor(number / 65536));
  const whole = bitWidth(number) - 1, first = whole < 12 ? number << (12 - whole) : number >> (whole - 12);
  const i = (first >> 8) & 15, part = first & 255;
  return 256 * whole + ((LOG[i] * (256 - part) + LOG[i + 1] * part + 128) >> 8);
};
const log16 = (number) => log2(number) >> 4;

/** 2^14 2^(-t / 1024). */
const halfPower = (t) => {
  const i = (t >> 6) & 15, part = t & 63;
  return t < 14336 ? ((POWER[i] * (64 - part) + POWER[i + 1] * part) >> 6) >> (t >> 10) : 0;
};

/**
 * By channel: how the distance over which a guess halves follows from nothing, and in 1/256 from the spread, the
 * surprise, the number of neighbours, the fineness, recent levels and the levels of two channels before; how that around
 * a neighbour differs, and in 1/256 by its fineness; the guess's weight and the pull of neighbours, in 1/256.
 */
const SHAPES = [
  [-3, -20, 17, -711, -58, 232, 0, 0, -4, 75, 68, 217],
  [-8, 33, 17, -638, -153, 243, 671, 0, -8, 100, 141, 183],
  [-35, 12, 14, -416, -165, 135, 838, 3379, 0, 46, 257, 183],
];

const bucket = (value, first, width, count) => clamp(divide(value - first, width), 0, count - 1);
const oddsBucket = (odds) => bucket(odds, -768, 64, 24);
const logBucket = (log) => bucket(log, -64, 10, 16);
const oddsBetween = (yes, no) => within(((log2(yes + 1) - log2(no + 1)) * 177) >> 8, 1800);
const inRange = (color) => clamp(color, -32768, 32767);

/** Decodes the colours of vertices. steps: of each channel; mean: of the areas of stars. */
const codeColors = (model, number, x, y, corner, areaOf, steps, mean) => {
  const count = x.length, channels = steps.length, edges = corner.length;
  const around = Array.from(x, () => []), star = ints(count), areaAt = (e) => areaOf(corner[e], corner[after(e)],
    corner[ahead(e)]);
  const color = ints(count * channels), calm = color.slice(), surprise = color.slice(), finenesses = ints(count),
    recents = ints(4).fill(4096);
  // Edges by their later vertex.
  corner.forEach((a, e) => {
    const b = corner[after(e)];
    star[a] += areaAt(e);
    around[max(a, b)].push(min(a, b) * edges + e);
  });
  const zero = model([96, 256, 1024, 256, 28], 4), negative = model([96, 28, 36], 4), larger = model([384, 256, 256], 3);

  // Of a vertex: its neighbours that are known, their weights and the sum of those, and what goes on in one channel.
  let neighbors, weights, all, fineness, channel, at, step, value, parts, total;
  const stepOf = (channel) => max((steps[channel] * fineness + 2048) >> 12, 1);
  /** The mean of something of neighbours, by their places in the arrays. */
  const average = (round, of) => round(neighbors.reduce((sum, u, k) => sum + weights[k] * of(u * channels + channel),
    0), all);
  /** Adds a value to the mixture of where a colour may lie, and the distance over which it halves. */
  const add = (place, log, weight) => {
    const l = clamp(log, -80, 144) + 80, half = floor((step * halfPower((15 - (l & 15)) * 64) * (1 << (l >> 4))) / 2 ** 18);
    parts.push([place, divide(2 ** 24, max(half, 1)), weight]);
    total += weight * EVEN;
  };
  /** The mixture's weight of what lies farther from 0 than a level does, on its side. */
  const beyond = (side, size) => {
    const place = value + side * (size * step + ((step + 1) >> 1));
    let sum = 0;
    for (const [middle, rate, weight] of parts) {
      const part = halfPower(divide(abs(place - middle) * rate, EVEN)) >> 1;
      sum += weight * (place < middle ? part : EVEN - part);
    }
    return side < 0 ? sum : total - sum;
  };
  const logOf = (distance) => log16(1 + (step >> 4) + distance) - log16(step);

  for (let v = 0; v < count; ++v) {
    const levels = ints(4), faces = [];
    let lightness; // that was guessed
    neighbors = [];
    // The latest neighbour first.
    for (const key of around[v].sort((a, b) => b - a)) {
      const u = divide(key, edges);
      if (u !== neighbors[neighbors.length - 1]) {
        neighbors.push(u);
        faces.push(0);
      }
      faces[faces.length - 1] += areaAt(key % edges);
    }
    neighbors.splice(12);
    weights = neighbors.map((u, k) =>
      (18 * log2(squared(x[v] - x[u], y[v] - y[u]) + 16) + 51 * log2(faces[k] + 8) + 22 * log2(star[u] + 8)) >> 6);
    all = 0;
    const most = max(...weights), nearest = neighbors[weights.indexOf(most)], known = neighbors.length;
    const shareOf = (t) => max(halfPower(t) >> 2, 1), flats = weights.map((w) => shareOf(most - w));
    weights.forEach((w, k) => (all += weights[k] = shareOf(4 * (most - w))));
    fineness = finenesses[v] = floor(Math.sqrt(4096 * clamp(divide(4096 * mean, max(star[v], 1)), 455, 36864)));

    for (channel = 0; channel < channels; ++channel) {
      at = v * channels + channel;
      step = stepOf(channel);
      value = v ? color[at - channels] : channel ? (channel > 2 || channels < 3 ? 16320 : 0) : channels < 3 ? 8192 : 14208;
      let spread = 0, surprised = 8 * step, off = 0;
      if (known) {
        value = average(rounded, (n) => calm[n]);
        if (channels > 2 && (channel === 1 || channel === 2)) {
          // Colour changes with lightness as it does among the neighbours, damped.
          const light = (n) => calm[n - channel] - lightness, both = average(divide, (n) => light(n) * (calm[n] - value));
          const variance = average(divide, (n) => light(n) ** 2) + floor((3 * stepOf(0) ** 2) / 2) + 1;
          value = inRange(value +
            ((within(rounded(256 * both, variance), 1024) * (color[at - channel] - lightness) + 256) >> 9));
        }
        spread = average(divide, (n) => abs(color[n] - value));
        surprised = average(rounded, (n) => surprise[n]);
        off = divide(8 * (color[nearest * channels + channel] - value), step);
      }
      lightness ??= value;
      spread = logOf(spread);
      surprised = logOf(surprised);

      // The mixture: around which values, over which distances they halve, and what they weigh.
      const shape = SHAPES[min(channel, 2)], [one, two] = levels;
      const size1 = min(abs(one), 3), size2 = min(abs(two), 3), logFineness = (v) => log16(finenesses[v]) - 192;
      const log = shape[0] + ((shape[1] * spread + shape[2] * surprised + shape[3] * min(known, 5) +
        shape[4] * logFineness(v) +
        shape[5] * (log16(1024 + recents[channel]) - 192) + shape[6] * size1 + shape[7] * size2) >> 8);
      parts = [];
      total = 0;
      neighbors.forEach((u, k) => {
        add(value + (((color[u * channels + channel] - value) * shape[11]) >> 8), log + shape[8] +
          ((shape[9] * logFineness(u)) >> 8), (channel ? flats : weights)[k]);
      });
      add(value, log, max(divide(total * shape[10], 2 ** 22), 1));

      const less = beyond(-1, 0), more = beyond(1, 0), size = abs(off), away = (size > 1) + (size > 5) + (size > 13);
      const nearBucket = channel * 7 + 3 + (off < 0 ? -away : away);
      spread = logBucket(spread);
      surprised = logBucket(surprised);
      let bits = oddsBetween(less + more, total - less - more), level = 0;
      if (zero(bits, channel, channel * 24 + oddsBucket(bits), (channel * 16 + spread) * 4 + clamp(known, 1, 4) - 1,
        (channel * 16 + surprised) * 16 + spread, ((channel * 4 + size1) * 4 + size2) * 4 + (surprised >> 2), nearBucket)) {
        bits = oddsBetween(less, more);
        const side = negative(bits, channel, channel * 24 + oddsBucket(bits), nearBucket, (channel * 3 + sign(one) +
          1) * 3 + sign(two) + 1) ? -1 : 1;
        let atLeast = beyond(side, 0);
        for (level = 1; level < 16; ++level) {
          const rest = beyond(side, level), few = min(level, 3);
          bits = oddsBetween(rest, atLeast - rest);
          if (!larger(bits, few - 1, (few * 4 + channel) * 24 + oddsBucket(bits), level * 16 + spread, level * 16 +
            surprised)) break;
          atLeast = rest;
        }
        level = side * (level < 16 ? level : level + min(number(0), 2 ** 16));
      }
      levels[channel] = level;
      color[at] = calm[at] = inRange(value + step * level);
      if (!known) continue;
      const miss = color[at] - value;
      calm[at] -= (miss * (channel ? 4 : 3) + 8) >> 4;
      surprise[at] = abs(miss);
      recents[channel] += divide(min(abs(level), 30) * 4096 - recents[channel], min(v + 4, 64));
    }
  }
  // From lightness and colour to red, green and blue.
  if (channels > 2)
    for (let i = 0; i < color.length; i += channels) {
      const light = 9459 * color[i] + 8192, across = 11585 * color[i + 1], along = 6689 * color[i + 2];
      color[i + 1] = (light - 13377 * color[i + 2]) >> 14;
      color[i] = (light + across + along) >> 14;
      color[i + 2] = (light - across + along) >> 14;
    }
  return color;
};

// ---- Drawing: vertices lie on 1/16 of a pixel, colours of pixels are in 1/2^16 of a grey level

const SUB = 16, TO_PIXEL = 1024;

/** A vertex on a side of the picture, on one of the drawing. The outermost half pixels belong to the border. */
const placeOf = (at, last, from, to) => {
  const out = divide(8 * (at + 2) * to + from, 2 * from) - SUB / 2;
  return !at ? min(out, 0) : at === last ? max(out, SUB * (to - 1)) : out;
};

/** Draws RGBA. Each face is linear in its colours; a later one overwrites. */
const draw = (px, py, corner, color, channels, width, height, columns, rows) => {
  const data = new Uint8ClampedArray(4 * width * height);
  // Of each channel of a pixel: the colour at one place, and what it gains to the right and down. Opaque without alpha.
  const here = ints(4), right = ints(4), down = ints(4);
  here[3] = 255 << 16;
  let row, from, to, area;
  const narrow = (p, q) => {
    const rise = py[q] - py[p], rest = (px[q] - px[p]) * (SUB * row - py[p]) + rise * px[p];
    if (rise < 0) from = max(from, -divide(rest, -SUB * rise));
    else if (rise) to = min(to, divide(rest, SUB * rise));
  };
  const slope = (rise) => divide(SUB * TO_PIXEL * rise + floor(area / 2), area) | 0;
  for (let f = 0; f < corner.length; f += 3) {
    const a = corner[f], ax = px[a], ay = py[a];
    let b = corner[f + 1], c = corner[f + 2], placedX = NONE, placedY = 0;
    if (cross(px[b] - ax, py[b] - ay, px[c] - ax, py[c] - ay) < 0) [b, c] = [c, b];
    const ux = px[b] - ax, uy = py[b] - ay, vx = px[c] - ax, vy = py[c] - ay, bottom = min(max(ay, py[b], py[c]) >> 4,
      rows - 1);
    area = cross(ux, uy, vx, vy);
    for (row = max((min(ay, py[b], py[c]) + SUB - 1) >> 4, 0); area && row <= bottom; ++row) {
      from = 0;
      to = columns - 1;
      narrow(a, b);
      narrow(b, c);
      narrow(c, a);
      if (from > to) continue;
      if (placedX < 0) {
        placedX = from;
        placedY = row;
        const wx = SUB * from - ax, wy = SUB * row - ay;
        for (let k = 3 - (channels & 1); k >= 0; --k) {
          const s = channels > 2 ? k : k === 3 ? 1 : 0, base = color[a * channels + s];
          const d1 = color[b * channels + s] - base, d2 = color[c * channels + s] - base;
          const above = cross(wx, wy, vx, vy) * d1 + cross(ux, uy, wx, wy) * d2, whole = divide(above, area);
          here[k] = (base + whole) * TO_PIXEL + rounded(TO_PIXEL * (above - whole * area), area);
          right[k] = slope(d1 * vy - d2 * uy);
          down[k] = slope(d2 * ux - d1 * vx);
        }
      }
      const start = (k) => (here[k] + right[k] * (from - placedX) + down[k] * (row - placedY)) | 0,
        end = 4 * (row * width + to);
      for (let k = 0; k < 3; ++k) {
        let value = start(k), alpha = start(3);
        for (let i = 4 * (row * width + from); i <= end; i += 4) {
          const opacity = clamp((alpha + 32768) >> 16, 0, 255);
          data[i + k] = opacity > 254 ? (value + 32768) >> 16 : opacity && divide(255 * value + floor(alpha / 2), alpha);
          data[i + 3] = opacity;
          value = (value + right[k]) | 0;
          alpha = (alpha + right[3]) | 0;
        }
      }
    }
  }
  return data;
};

// ---- What others call

/**
 * What a file says of its picture, from its first bytes.
 * @param {Uint8Array | ArrayBuffer} bytes
 * @returns {Info}
 * @throws {Error} if it is none
 */
export function info(bytes) {
  const [width, height, channels] = readHeader(new Uint8Array(bytes));
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
  bytes = new Uint8Array(bytes);
  const [ownWidth, ownHeight, channels, start] = readHeader(bytes), right = 4 * max(ownWidth - 1, 1),
    bottom = 4 * max(ownHeight - 1, 1);
  const [model, bits, number, end] = rangeDecoder(bytes, start), step = min(number(2), 4 * MAX_SIDE) + 1, steps = [];
  const columns = ceil(right / step) + 1, rows = ceil(bottom / step) + 1;
  if (columns * rows > MAX_PIXELS) damaged();
  const first = bits(8);
  for (let k = 0; k < channels; ++k) {
    const index = k ? first - 8 + bits(5) : first;
    if (index >>> 0 > 143) damaged();
    steps.push((16 + (index & 15)) << (index >> 4));
  }
  const wide = columns - 2, high = rows - 2, line = 2 * (wide + high), inner = number(7), outer = number(4);
  if (inner > wide * high || outer > line || inner + outer > 4096 + 16 * bytes.length) damaged();
  const corners = [0, columns - 1, (rows - 1) * columns, rows * columns - 1];
  // Top, right, bottom, left.
  const border = codePoints(model, line, 1, outer).map((k) =>
    k < wide ? k + 1
    : (k -= wide) < high ? (k + 2) * columns - 1
    : (k -= high) < wide ? corners[2] + k + 1
    : (k - wide + 1) * columns);
  const inside = codePoints(model, wide, high, inner).map((k) => (divide(k, wide) + 1) * columns + (k % wide) + 1);
  const points = ints([...corners, ...border, ...inside]).sort();
  end();
  const column = points.map((p) => p % columns), row = points.map((p) => divide(p, columns));
  const x = column.map((at) => min(at * step, right)), y = row.map((at) => min(at * step, bottom));
  // Along a curve that fills the plane: by the bits of rows and columns in turn.
  const order = points.map((_, v) => v).sort((v, w) =>
    clz32(column[v] ^ column[w]) < clz32(row[v] ^ row[w]) ? column[v] - column[w] : row[v] - row[w]);
  const [corner, area] = codeFaces(model, x, y, order);
  const color = codeColors(model, number, x, y, corner, area, steps, divide(6 * right * bottom, points.length));
  end(true);

  const whole = (x) => max(1, Math.round(x));
  scale = width ? width / ownWidth : height ? height / ownHeight : scale;
  width = whole(width ?? ownWidth * scale);
  height = whole(height ?? ownHeight * scale);
  checkSize(width, height);
  // One column of a picture that has only one is drawn, and repeated.
  const across = ownWidth < 2 ? 1 : width, down = ownHeight < 2 ? 1 : height;
  const px = x.map((at) => placeOf(at, right, ownWidth, across)), py = y.map((at) => placeOf(at, bottom, ownHeight, down));
  const data = draw(px, py, corner, color, channels, width, height, across, down);
  if (across * down < width * height)
    for (let i = 0; i < data.length; ++i)
      data[i] = data[4 * (min(floor(i / 4 / width), down - 1) * width + min(floor(i / 4) % width, across - 1)) + (i % 4)];
  return { width, height, channels, data };
}

/**
 * Draws a file to a canvas, which gets the size of the drawing.
 * @param {HTMLCanvasElement | OffscreenCanvas} canvas
 * @param {Uint8Array | ArrayBuffer} bytes
 * @param {Size} [size]
 */
export function drawTo(canvas, bytes, size) {
  const { width, height, data } = decode(bytes, size);
  Object.assign(canvas, { width, height }).getContext("2d").putImageData(new ImageData(data, width, height), 0, 0);
}
