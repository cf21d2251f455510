// The warped image, drawn by WebGL as a grid of triangles. Corners of the grid find how far they move in the
// vertex shader, so a step of a drag uploads only the moves of the vertices.
import type { ViewTransform } from "../contracts";
import { kPlace, makeProgram, setTransform } from "../layers/gl";
import type { SampledMaps } from "../worker/warp_samples";

/** Samples of the pixel maps that are kept, and triangles' corners that are drawn while a hand drags. */
export const kMostSamples = 1.2e6;
const kDragCorners = 1.6e4;
/** Width of the textures that hold lists. */
const kListWidth = 1024;

const kVertex = `
precision highp int;
uniform highp usampler2DArray faceMap;   // face of every sample, one layer a level
uniform highp sampler2DArray weightMap;  // weights of the second and third corner
uniform highp usampler2D corners;        // of all faces of all levels
uniform highp sampler2D moves;           // of all vertices of all levels, in pixels
uniform int levels;
uniform uint moving;  // a bit for each level that moves
uniform ivec2 samples;
uniform int stride;   // samples between corners of the grid
uniform float pace;   // pixels between samples
uniform vec2 image;   // size in pixels
out vec2 at;
out float inside;
${kPlace}
vec2 moveOf(uint v) {
  return texelFetch(moves, ivec2(int(v) & ${kListWidth - 1}, int(v) / ${kListWidth}), 0).xy;
}
void main() {
  ivec2 corner = ivec2(gl_VertexID >> 1, gl_InstanceID + (gl_VertexID & 1)) * stride, s = min(corner, samples - 1);
  vec2 p = min(vec2(s) * pace, image - 1.0);
  vec2 move = vec2(0.0);
  inside = texelFetch(faceMap, ivec3(s, 0), 0).x == 0xffffffffu ? 0.0 : 1.0;
  for (int k = 0; k < levels; ++k) {
    uint f = texelFetch(faceMap, ivec3(s, k), 0).x;
    if (f == 0xffffffffu || (moving >> uint(k) & 1u) == 0u) continue;
    uvec3 c = texelFetch(corners, ivec2(int(f) & ${kListWidth - 1}, int(f) / ${kListWidth}), 0).xyz;
    vec2 w = texelFetch(weightMap, ivec3(s, k), 0).xy, first = moveOf(c.x);
    move += first + w.x * (moveOf(c.y) - first) + w.y * (moveOf(c.z) - first);
  }
  // The outermost half pixel moves as the pixels beside it do.
  if (corner.x == 0) p.x -= 0.5;
  else if (s.x == samples.x - 1) p.x += 0.5;
  if (corner.y == 0) p.y -= 0.5;
  else if (s.y == samples.y - 1) p.y += 0.5;
  at = (p + 0.5) / image;
  gl_Position = vec4(place(p + move), 0.0, 1.0);
}`;

const kFragment = `
uniform sampler2D picture;
in vec2 at;
in float inside;
out vec4 result;
void main() {
  if (inside < 0.999) discard;
  result = texture(picture, at);
  if (result.a == 0.0) discard;
  // What is turned over lies below what is not.
  gl_FragDepth = gl_FrontFacing ? 0.25 : 0.75;
}`;

type Gl = WebGL2RenderingContext;
const kNames = ["faceMap", "weightMap", "corners", "moves", "picture"] as const;

interface Uploaded {
  of: Gl;
  textures: Record<(typeof kNames)[number], WebGLTexture>;
  moves: number;
}

let program: { of: Gl; program: WebGLProgram; places: Map<string, WebGLUniformLocation | null> } | null = null;

/** Makes a texture that is read texel by texel. */
function texture(gl: Gl, target: number): WebGLTexture {
  const made = gl.createTexture();
  gl.bindTexture(target, made);
  for (const [name, value] of [
    [gl.TEXTURE_MIN_FILTER, gl.NEAREST], [gl.TEXTURE_MAG_FILTER, gl.NEAREST],
    [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE],
  ] as const)
    gl.texParameteri(target, name, value);
  return made;
}

export class Preview {
  /** Whether a coarse grid does: while a hand drags, and where the exact image comes soon. */
  coarse = false;
  private readonly maps: SampledMaps;
  private readonly picture: ImageBitmap;
  private readonly total: number;
  private moves: Float32Array;
  private moving = 0;
  private version = 0;
  private uploaded: Uploaded | null = null;

  constructor(maps: SampledMaps, picture: ImageBitmap) {
    this.maps = maps;
    this.picture = picture;
    this.total = maps.levels.reduce((sum, { vertices }) => sum + vertices, 0);
    this.moves = new Float32Array(2 * kListWidth * Math.ceil(this.total / kListWidth));
  }

  /** Takes the moves of every level's vertices; empty for a level that does not move. */
  setMoves(moves: readonly Float32Array[]): void {
    let at = 0;
    this.moving = 0;
    this.maps.levels.forEach(({ vertices }, k) => {
      const own = moves[k];
      if (own && own.length > 0) {
        this.moves.set(own, 2 * at);
        this.moving |= 1 << k;
      }
      at += vertices;
    });
    ++this.version;
  }

  /** Draws into a canvas of the size of `context`'s. */
  draw(gl: Gl, context: CanvasRenderingContext2D, t: ViewTransform): void {
    if (program?.of !== gl) program = { of: gl, program: makeProgram(gl, kVertex, kFragment), places: new Map() };
    if (this.uploaded?.of !== gl) this.uploaded = this.upload(gl);
    const { program: shader, places } = program, { textures } = this.uploaded;
    if (this.uploaded.moves !== this.version) this.uploadMoves(gl, this.uploaded);
    const { columns, rows, step, width, height, levels } = this.maps;
    const most = this.coarse ? kDragCorners : Infinity;
    const stride = Math.max(1, Math.ceil(Math.sqrt((columns * rows) / most)));
    const corners = (count: number): number => Math.max(Math.ceil((count - 1) / stride), 1) + 1;
    const at = (name: string): WebGLUniformLocation | null => {
      if (!places.has(name)) places.set(name, gl.getUniformLocation(shader, name));
      return places.get(name)!;
    };
    gl.useProgram(shader);
    setTransform(gl, shader, context, t);
    kNames.forEach((name, unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(name.endsWith("Map") ? gl.TEXTURE_2D_ARRAY : gl.TEXTURE_2D, textures[name]);
      gl.uniform1i(at(name), unit);
    });
    gl.activeTexture(gl.TEXTURE0);
    gl.uniform1i(at("levels"), levels.length);
    gl.uniform1ui(at("moving"), this.moving);
    gl.uniform2i(at("samples"), columns, rows);
    gl.uniform1i(at("stride"), stride);
    gl.uniform1f(at("pace"), step);
    gl.uniform2f(at("image"), width, height);
    gl.bindVertexArray(null);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    // Faces run counter-clockwise on screen, strips clockwise: y grows down.
    gl.frontFace(gl.CW);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 2 * corners(columns), corners(rows) - 1);
    gl.disable(gl.DEPTH_TEST);
  }

  /** Forgets what a context that was lost has held. */
  forget(): void {
    this.uploaded = null;
    program = null;
  }

  /** Gives the graphics card's memory back. */
  close(): void {
    if (this.uploaded) for (const t of Object.values(this.uploaded.textures)) this.uploaded.of.deleteTexture(t);
    this.uploaded = null;
  }

  private upload(gl: Gl): Uploaded {
    const { columns, rows, levels } = this.maps, layers = levels.length;
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    const faceMap = texture(gl, gl.TEXTURE_2D_ARRAY);
    gl.texStorage3D(gl.TEXTURE_2D_ARRAY, 1, gl.R32UI, columns, rows, layers);
    const weightMap = texture(gl, gl.TEXTURE_2D_ARRAY);
    gl.texStorage3D(gl.TEXTURE_2D_ARRAY, 1, gl.RG32F, columns, rows, layers);
    const faces = levels.reduce((sum, level) => sum + level.corners.length / 3, 0);
    const lines = Math.ceil(faces / kListWidth), list = new Uint32Array(4 * kListWidth * lines);
    let face = 0, vertex = 0;
    levels.forEach((level, k) => {
      const numbered = level.faces.map((f) => (f === 0xffffffff ? f : f + face));
      gl.bindTexture(gl.TEXTURE_2D_ARRAY, faceMap);
      gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, 0, k, columns, rows, 1, gl.RED_INTEGER, gl.UNSIGNED_INT, numbered);
      gl.bindTexture(gl.TEXTURE_2D_ARRAY, weightMap);
      gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, 0, k, columns, rows, 1, gl.RG, gl.FLOAT, level.weights);
      for (let i = 0; i < level.corners.length; ++i) list[4 * (face + Math.floor(i / 3)) + (i % 3)] = level.corners[i]! + vertex;
      face += level.corners.length / 3;
      vertex += level.vertices;
    });
    const corners = texture(gl, gl.TEXTURE_2D);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32UI, kListWidth, lines);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, kListWidth, lines, gl.RGBA_INTEGER, gl.UNSIGNED_INT, list);
    const moves = texture(gl, gl.TEXTURE_2D);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RG32F, kListWidth, this.moves.length / 2 / kListWidth);
    return { of: gl, textures: { faceMap, weightMap, corners, moves, picture: this.uploadPicture(gl) }, moves: -1 };
  }

  private uploadPicture(gl: Gl): WebGLTexture {
    const made = texture(gl, gl.TEXTURE_2D), { width, height } = this.picture;
    const share = Math.min(1, gl.getParameter(gl.MAX_TEXTURE_SIZE) / Math.max(width, height));
    let source: TexImageSource = this.picture;
    if (share < 1) {
      source = new OffscreenCanvas(Math.max(1, Math.floor(share * width)), Math.max(1, Math.floor(share * height)));
      source.getContext("2d")!.drawImage(this.picture, 0, 0, source.width, source.height);
    }
    gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, true);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, source);
    gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, false);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
    gl.generateMipmap(gl.TEXTURE_2D);
    return made;
  }

  private uploadMoves(gl: Gl, uploaded: Uploaded): void {
    gl.bindTexture(gl.TEXTURE_2D, uploaded.textures.moves);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, kListWidth, this.moves.length / 2 / kListWidth, gl.RG, gl.FLOAT, this.moves);
    uploaded.moves = this.version;
  }
}
