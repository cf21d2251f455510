// The edges of the mesh as lines of constant width, sharp at every zoom.
import type { Overlay, ViewTransform } from "../contracts";
import type { MeshArrays } from "../worker/view";
import { glCanvas, kPlace, makeProgram, paintOver, setTransform } from "./gl";

// Each edge is a strip of two triangles, wider than the line, so that its border can be smooth.
const kVertex = `
layout(location = 0) in vec4 ends;
uniform float ratio;  // device pixels for each CSS pixel
out float across;     // distance from the line's middle, in device pixels
${kPlace}
void main() {
  vec2 a = place(ends.xy), b = place(ends.zw);
  vec2 along = (b - a) * size;
  along = length(along) > 0.0 ? normalize(along) : vec2(1.0, 0.0);
  float side = (gl_VertexID & 1) == 0 ? -1.0 : 1.0;
  float reach = 1.2 + ratio;  // in device pixels
  across = side * reach;
  vec2 offset = vec2(-along.y, along.x) * side * reach / ratio * 2.0 / size;
  gl_Position = vec4((gl_VertexID < 2 ? a : b) + offset, 0.0, 1.0);
}`;

// Light with a dark rim: seen on every image.
const kFragment = `
in float across;
uniform float ratio;
uniform float strength;
out vec4 result;
void main() {
  float d = abs(across);
  float core = 1.0 - smoothstep(0.45 * ratio - 0.4, 0.45 * ratio + 0.6, d);
  float rim = 0.4 * (1.0 - smoothstep(0.45 * ratio, 0.45 * ratio + 1.4, d));
  float alpha = max(core, rim) * strength;
  result = vec4(vec3(core) * strength, alpha);
}`;

const programs = new WeakMap<WebGL2RenderingContext, WebGLProgram>();

function putEndPoints(positions: Float32Array, edges: Uint32Array, ends: Float32Array): void {
  for (let i = 0; i < edges.length; ++i) {
    ends[2 * i] = positions[2 * edges[i]!]!;
    ends[2 * i + 1] = positions[2 * edges[i]! + 1]!;
  }
}

/** How strong lines are: where they are closer than a few pixels, they would hide what is below. */
function strengthOf(spacing: number): number {
  return Math.min(Math.max((spacing - 1) / 9, 0.12), 0.9);
}

export interface MovableWire extends Overlay {
  /** Draws the mesh with its vertices at other places. */
  move(positions: Float32Array): void;
  /** Draws into a canvas of the size of `context`'s. */
  paint(gl: WebGL2RenderingContext, context: CanvasRenderingContext2D, t: ViewTransform): void;
}

/** The overlay of a mesh of an image with `area` pixels. */
export function wireOverlay(arrays: MeshArrays, area: number): MovableWire {
  const ends = new Float32Array(2 * arrays.edges.length);
  putEndPoints(arrays.positions, arrays.edges, ends);
  const count = ends.length / 4;
  const meanLength = Math.sqrt(area / Math.max(arrays.faces.length / 3, 1)) * 1.5;
  const uploaded = new WeakMap<WebGL2RenderingContext, { vao: WebGLVertexArrayObject; buffer: WebGLBuffer; version: number }>();
  let at = arrays.positions, version = 0;

  const upload = (gl: WebGL2RenderingContext) => {
    const vao = gl.createVertexArray(), buffer = gl.createBuffer();
    gl.bindVertexArray(vao);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, ends, gl.DYNAMIC_DRAW);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 4, gl.FLOAT, false, 16, 0);
    gl.vertexAttribDivisor(0, 1);
    const made = { vao, buffer, version };
    uploaded.set(gl, made);
    return made;
  };
  const paint = (gl: WebGL2RenderingContext, context: CanvasRenderingContext2D, t: ViewTransform): void => {
    let program = programs.get(gl);
    if (!program) programs.set(gl, (program = makeProgram(gl, kVertex, kFragment)));
    const lines = uploaded.get(gl) ?? upload(gl);
    if (lines.version !== version) {
      gl.bindBuffer(gl.ARRAY_BUFFER, lines.buffer);
      gl.bufferSubData(gl.ARRAY_BUFFER, 0, ends);
      lines.version = version;
    }
    gl.useProgram(program);
    setTransform(gl, program, context, t);
    gl.uniform1f(gl.getUniformLocation(program, "ratio"), t.ratio);
    gl.uniform1f(gl.getUniformLocation(program, "strength"), strengthOf(meanLength * t.scale));
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.bindVertexArray(lines.vao);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
  };

  const byCanvas = (context: CanvasRenderingContext2D, t: ViewTransform): void => {
    context.beginPath();
    for (let i = 0; i < ends.length; i += 4) {
      const a = t.toScreen({ x: ends[i]!, y: ends[i + 1]! }), b = t.toScreen({ x: ends[i + 2]!, y: ends[i + 3]! });
      if (Math.max(a.x, b.x) < 0 || Math.min(a.x, b.x) > t.width) continue;
      if (Math.max(a.y, b.y) < 0 || Math.min(a.y, b.y) > t.height) continue;
      context.moveTo(a.x, a.y);
      context.lineTo(b.x, b.y);
    }
    context.strokeStyle = `rgb(255 255 255 / ${strengthOf(meanLength * t.scale)})`;
    context.lineWidth = 1;
    context.stroke();
  };

  return {
    move(positions) {
      if (positions === at) return;
      at = positions;
      ++version;
      putEndPoints(positions, arrays.edges, ends);
    },
    paint,
    draw(context, t) {
      const shared = glCanvas();
      if (shared) paintOver(context, t, shared, () => paint(shared.gl, context, t));
      else byCanvas(context, t);
    },
  };
}
