// Small images that tests draw themselves.

function drawn(width, height, color) {
  const data = new Uint8ClampedArray(4 * width * height);
  for (let y = 0; y < height; ++y) for (let x = 0; x < width; ++x) data.set(color(x, y), 4 * (y * width + x));
  return { width, height, data };
}

/** Soft colours and two sharp edges; opaque. */
export function landscape(width = 96, height = 72) {
  return drawn(width, height, (x, y) => {
    const hill = y > 0.6 * height + 6 * Math.sin(x / 9), sun = Math.hypot(x - 0.7 * width, y - 0.25 * height) < 9;
    return sun ? [250, 220, 90, 255] : hill ? [60, 110 + (x % 32), 50, 255] : [90, 140 + y, 230 - (x >> 1), 255];
  });
}

/** A ring with an antialiased edge; transparent around it and in its hole. */
export function ring(size = 80) {
  const middle = (size - 1) / 2;
  return drawn(size, size, (x, y) => {
    const radius = Math.hypot(x - middle, y - middle);
    const cover = Math.max(0, Math.min(1, 0.44 * size - radius, radius - 0.2 * size));
    return [200 - x, 80 + y, (x * y) >> 5, Math.round(255 * cover)];
  });
}

/** Pixels of a function of x and y that returns R, G, B and perhaps A. */
export function pixelsOf(width, height, color) {
  const data = new Uint8ClampedArray(4 * width * height);
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) {
      const [r, g, b, a = 255] = color(x, y);
      data.set([r, g, b, a], 4 * (y * width + x));
    }
  return { width, height, data };
}
