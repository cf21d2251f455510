// The borders of tiles, coloured by their level.
import type { Transform } from "../../studio/src/view/transform";
import type { ShownTile } from "./tile_scene";

/** From the finest level on; then they begin again. They differ in lightness too. */
const kColors = ["#00c2a8", "#ffb000", "#dc267f", "#648fff", "#fe6100", "#a78bfa"];

export const colorOf = (level: number): string => kColors[level % kColors.length]!;

/** Draws them, in device pixels inside; or clears the canvas if there are no tiles. */
export function drawFrames(canvas: HTMLCanvasElement, tiles: readonly ShownTile[], transform: Transform): void {
  const { width, height, ratio } = transform;
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  const context = canvas.getContext("2d");
  if (!context) return;
  context.scale(ratio, ratio);
  context.font = "600 12px system-ui, sans-serif";
  context.textBaseline = "middle";
  for (const { level, left, top, right, bottom } of tiles) {
    const a = transform.toScreen({ x: left, y: top }), b = transform.toScreen({ x: right, y: bottom });
    const w = b.x - a.x, h = b.y - a.y;
    context.fillStyle = context.strokeStyle = colorOf(level);
    context.globalAlpha = 0.1;
    context.fillRect(a.x, a.y, w, h);
    context.globalAlpha = 1;
    context.lineWidth = 1.5;
    context.strokeRect(a.x + 1, a.y + 1, w - 2, h - 2);
    const text = `level ${level}`, long = context.measureText(text).width + 10;
    if (w < long + 8 || h < 28) continue;
    context.fillRect(a.x + 1, a.y + 1, long, 20);
    context.fillStyle = "#101214";
    context.fillText(text, a.x + 6, a.y + 11.5);
  }
}
