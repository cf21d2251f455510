// What drawings by WebGL share: programs, and a canvas that is copied onto the view's.
import type { ViewTransform } from "../contracts";

export interface GlCanvas {
  canvas: OffscreenCanvas;
  gl: WebGL2RenderingContext;
}

let shared: GlCanvas | null | undefined;

/** The canvas that all drawings use, one after another; null where the browser has no WebGL 2. */
export function glCanvas(): GlCanvas | null {
  if (shared !== undefined && !shared?.gl.isContextLost()) return shared;
  const canvas = new OffscreenCanvas(1, 1);
  const gl = canvas.getContext("webgl2", { antialias: true, premultipliedAlpha: true });
  shared = gl ? { canvas, gl } : null;
  return shared;
}

export function makeProgram(gl: WebGL2RenderingContext, vertex: string, fragment: string): WebGLProgram {
  const program = gl.createProgram();
  for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]] as const) {
    const shader = gl.createShader(type);
    if (!shader) break;
    gl.shaderSource(shader, `#version 300 es\nprecision highp float;\n${text}`);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost())
    throw new Error(`a drawing by WebGL failed: ${gl.getProgramInfoLog(program)}`);
  return program;
}

/** Clears the shared canvas at the size of the view's, calls `paint`, and copies the result. */
export function paintOver(
  context: CanvasRenderingContext2D,
  t: ViewTransform,
  { canvas, gl }: GlCanvas,
  paint: () => void,
): void {
  const { width, height } = context.canvas;
  if (canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
  }
  gl.viewport(0, 0, width, height);
  gl.clearColor(0, 0, 0, 0);
  gl.clear(gl.COLOR_BUFFER_BIT);
  gl.disable(gl.DEPTH_TEST);
  paint();
  context.drawImage(canvas, 0, 0, width, height, 0, 0, width / t.ratio, height / t.ratio);
}

/** GLSL: the place of an image point in clip space, by the uniforms that setTransform() sets. */
export const kPlace = `
uniform vec3 view;  // x, y and scale, in CSS pixels
uniform vec2 size;  // of the canvas, in CSS pixels
vec2 place(vec2 p) {
  vec2 s = (view.xy + (p + 0.5) * view.z) / size;
  return vec2(2.0 * s.x - 1.0, 1.0 - 2.0 * s.y);
}
`;

export function setTransform(
  gl: WebGL2RenderingContext,
  program: WebGLProgram,
  context: CanvasRenderingContext2D,
  t: ViewTransform,
): void {
  gl.uniform3f(gl.getUniformLocation(program, "view"), t.x, t.y, t.scale);
  // The canvas has whole pixels, which t.width and t.height may miss by a part of one.
  gl.uniform2f(gl.getUniformLocation(program, "size"), context.canvas.width / t.ratio, context.canvas.height / t.ratio);
}
