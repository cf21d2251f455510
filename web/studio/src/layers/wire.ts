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

let program: { of: WebGL2RenderingContext; program: WebGLProgram } | null = null;

function endPoints({ positions, edges }: MeshArrays): Float32Array {
  const ends = new Float32Array(2 * edges.length);
  for (let i = 0; i < edges.length; ++i) {
    ends[2 * i] = positions[2 * edges[i]!]!;
    ends[2 * i + 1] = positions[2 * edges[i]! + 1]!;
  }
  return ends;
}

/** How strong lines are: where they are closer than a few pixels, they would hide what is below. */
function strengthOf(spacing: number): number {
  return Math.min(Math.max((spacing - 1) / 9, 0.12), 0.9);
}

/** The overlay of a mesh of an image with `area` pixels. */
export function wireOverlay(arrays: MeshArrays, area: number): Overlay {
  const ends = endPoints(arrays);
  const count = ends.length / 4;
  const meanLength = Math.sqrt(area / Math.max(arrays.faces.length / 3, 1)) * 1.5;
  let uploaded: { of: WebGL2RenderingContext; vao: WebGLVertexArrayObject } | null = null;

  const byWebGl = (context: CanvasRenderingContext2D, t: ViewTransform): boolean => {
    const shared = glCanvas();
    if (!shared) return false;
    const { gl } = shared;
    if (program?.of !== gl) program = { of: gl, program: makeProgram(gl, kVertex, kFragment) };
    if (uploaded?.of !== gl) {
      const vao = gl.createVertexArray();
      gl.bindVertexArray(vao);
      gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ARRAY_BUFFER, ends, gl.STATIC_DRAW);
      gl.enableVertexAttribArray(0);
      gl.vertexAttribPointer(0, 4, gl.FLOAT, false, 16, 0);
      gl.vertexAttribDivisor(0, 1);
      uploaded = { of: gl, vao };
    }
    const { vao } = uploaded;
    paintOver(context, t, shared, () => {
      gl.useProgram(program!.program);
      setTransform(gl, program!.program, context, t);
      gl.uniform1f(gl.getUniformLocation(program!.program, "ratio"), t.ratio);
      gl.uniform1f(gl.getUniformLocation(program!.program, "strength"), strengthOf(meanLength * t.scale));
      gl.enable(gl.BLEND);
      gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
      gl.bindVertexArray(vao);
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
    });
    return true;
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
    draw(context, t) {
      if (!byWebGl(context, t)) byCanvas(context, t);
    },
  };
}
