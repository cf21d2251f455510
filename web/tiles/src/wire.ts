// The edges of triangles, above the picture of which they are.
import { type Material, Mesh, type Object3D, ShaderMaterial } from "three";

/** How far before the picture lines lie [px]: less than skirts lie behind it, so that theirs stay hidden. */
const kLift = 1 / 64;

/**
 * Lines that are light on dark colours and dark on light ones. Where they are closer than a few pixels, they are
 * faint, as they would hide what is below: `spacing` is that of vertices on the screen, in CSS pixels.
 */
export function wireMaterial(): ShaderMaterial {
  return new ShaderMaterial({
    wireframe: true,
    transparent: true,
    depthWrite: false,
    vertexColors: true,
    uniforms: { spacing: { value: 10 } },
    vertexShader: `
      varying vec3 shade;
      void main() {
        shade = color.rgb;
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
      }`,
    fragmentShader: `
      uniform float spacing;
      varying vec3 shade;
      void main() {
        float light = dot(shade, vec3(0.2126, 0.7152, 0.0722));
        gl_FragColor = vec4(vec3(light < 0.18 ? 1.0 : 0.0), clamp((spacing - 1.0) / 16.0, 0.08, 0.6));
      }`,
  });
}

/** The meshes below `scene`, but for skirts. */
export function pictureMeshes(scene: Object3D): Mesh[] {
  const meshes: Mesh[] = [];
  scene.traverse((part) => {
    if (part instanceof Mesh && part.name !== "skirt") meshes.push(part);
  });
  return meshes;
}

/** Puts lines before every mesh below `scene`. They use its geometry, and are seen while the material is visible. */
export function addWire(scene: Object3D, material: Material): void {
  for (const mesh of pictureMeshes(scene)) {
    if (!mesh.geometry.attributes["color"]) continue;
    const lines = new Mesh(mesh.geometry, material);
    lines.position.z = kLift;
    lines.frustumCulled = false;
    mesh.add(lines);
  }
}
