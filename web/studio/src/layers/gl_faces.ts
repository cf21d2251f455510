// Faces drawn by WebGL, sharp at every zoom: colours interpolated over them in L*u*v*, or one for each.
import type { ViewTransform } from "../contracts";
import type { MeshArrays } from "../worker/view";
import { glCanvas, kPlace, makeProgram, paintOver, setTransform } from "./gl";

const kVertex = `
layout(location = 0) in vec2 position;
layout(location = 1) in vec4 color;
out vec4 luv;
${kPlace}
void main() {
  luv = color;
  gl_Position = vec4(place(position), 0.0, 1.0);
}`;

// As linear_from_luv() of libcore: D65, and nothing but black below L* = 0.
const kFragment = `
in vec4 luv;
out vec4 result;
void main() {
  float l = luv.x;
  vec3 xyz = vec3(0.0);
  if (l > 0.0) {
    float y = l > 8.0 ? pow((l + 16.0) / 116.0, 3.0) : l * 27.0 / 24389.0;
    float u = luv.y / (13.0 * l) + 0.1978300066428368, v = luv.z / (13.0 * l) + 0.4683199493879100;
    xyz = vec3(y * 9.0 * u / (4.0 * v), y, y * (12.0 - 3.0 * u - 20.0 * v) / (4.0 * v));
  }
  vec3 rgb = clamp(mat3(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108, -0.2040259,
                        -0.4985314, 0.0415560, 1.0572252) * xyz, 0.0, 1.0);
  rgb = mix(12.92 * rgb, 1.055 * pow(rgb, vec3(1.0 / 2.4)) - 0.055, vec3(greaterThan(rgb, vec3(0.0031308))));
  float alpha = clamp(luv.w, 0.0, 1.0);
  result = vec4(rgb * alpha, alpha);
}`;

let program: { of: WebGL2RenderingContext; program: WebGLProgram } | null = null;

/** Positions and colours of the three corners of every face, 6 numbers each. */
function corners({ positions, faces, features }: MeshArrays, flat: boolean, alphaAt: number): Float32Array {
  const channels = (features.length / positions.length) * 2;
  const out = new Float32Array(6 * faces.length);
  const mean = [0, 0, 0, 0];
  for (let f = 0; f < faces.length; f += 3) {
    for (let c = 0; flat && c < 4; ++c) {
      mean[c] = 0;
      for (let k = 0; k < 3; ++k)
        mean[c]! += (c < 3 ? features[faces[f + k]! * channels + c]! : alpha(faces[f + k]!)) / 3;
    }
    for (let k = 0; k < 3; ++k) {
      const v = faces[f + k]!, at = 6 * (f + k);
      out[at] = positions[2 * v]!;
      out[at + 1] = positions[2 * v + 1]!;
      for (let c = 0; c < 3; ++c) out[at + 2 + c] = flat ? mean[c]! : features[v * channels + c]!;
      out[at + 5] = flat ? mean[3]! : alpha(v);
    }
  }
  function alpha(v: number): number {
    return alphaAt < 0 ? 1 : features[v * channels + alphaAt]!;
  }
  return out;
}

/**
 * Returns a function that draws the faces, or null where there is no WebGL. `alphaAt` is the feature that is
 * alpha, or -1.
 */
export function facePainter(arrays: MeshArrays, flat: boolean, alphaAt: number) {
  if (!glCanvas()) return null;
  let uploaded: { of: WebGL2RenderingContext; vao: WebGLVertexArrayObject } | null = null;
  return (context: CanvasRenderingContext2D, t: ViewTransform): void => {
    const shared = glCanvas();
    if (!shared) return;
    const { gl } = shared;
    if (program?.of !== gl) program = { of: gl, program: makeProgram(gl, kVertex, kFragment) };
    if (uploaded?.of !== gl) {
      const vao = gl.createVertexArray();
      gl.bindVertexArray(vao);
      gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ARRAY_BUFFER, corners(arrays, flat, alphaAt), gl.STATIC_DRAW);
      gl.enableVertexAttribArray(0);
      gl.vertexAttribPointer(0, 2, gl.FLOAT, false, 24, 0);
      gl.enableVertexAttribArray(1);
      gl.vertexAttribPointer(1, 4, gl.FLOAT, false, 24, 8);
      uploaded = { of: gl, vao };
    }
    const { vao } = uploaded;
    paintOver(context, t, shared, () => {
      gl.useProgram(program!.program);
      setTransform(gl, program!.program, context, t);
      gl.disable(gl.BLEND);
      gl.bindVertexArray(vao);
      gl.drawArrays(gl.TRIANGLES, 0, arrays.faces.length);
    });
  };
}
