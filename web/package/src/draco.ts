// Draco, by npm's draco3d: loaded when a container needs it, as it is larger than the engine.

export interface DracoAttribute {
  id: number;
  kind: "position" | "color" | "texcoord" | "generic";
  components: number;
  type: "float" | "uint16";
  bytes: Uint8Array;
}

export interface DracoTask {
  attributes: DracoAttribute[];
  points: number;
  /** Three indices of 32 bits a face. */
  faces: Uint8Array;
  edgebreaker: boolean;
  /** Of the positions' quantisation. */
  bits: number;
  origin: number[];
  range: number;
}

export interface DracoMesh {
  points: number;
  attributes: number;
  faces: Uint32Array;
  /** The values of all points, or null if there is no such attribute. */
  attribute(id: number, kind: string, components: number, type: string): Uint8Array | null;
}

/** What the engine calls. Where it fails, it returns one line of text. */
export interface DracoCoder {
  encode(task: DracoTask): Uint8Array | string;
  decode(bytes: Uint8Array): DracoMesh | string;
}

/** What draco3d's two modules have; their own names. */
// eslint-disable-next-line @typescript-eslint/no-explicit-any
type DracoModule = any;
type Create = (options: { wasmBinary?: BufferSource }) => Promise<DracoModule>;

/** Where draco3d's two .wasm files are, or their bytes; beside the package's files unless it is said. */
export interface DracoSource {
  encoder?: string | URL | BufferSource;
  decoder?: string | URL | BufferSource;
}

let coder: DracoCoder | null = null;
let loading: Promise<void> | null = null;

export function loadedDraco(): DracoCoder | null {
  return coder;
}

async function bytesOf(source: string | URL | BufferSource): Promise<BufferSource> {
  if (typeof source !== "string" && !(source instanceof URL)) return source;
  const response = await fetch(source);
  if (!response.ok) throw new Error(`${source}: the server answers ${response.status}, expected Draco`);
  return response.arrayBuffer();
}

/**
 * Loads Draco, once; open() and save() of containers with Draco need it. After a mesh that Draco could not stand it
 * loads it anew.
 */
export function startDraco(source: Required<DracoSource>): Promise<void> {
  if (coder) return Promise.resolve();
  loading ??= (async () => {
    try {
      const [encoderWasm, decoderWasm, encoderJs, decoderJs] = await Promise.all([
        bytesOf(source.encoder),
        bytesOf(source.decoder),
        import("draco3d/draco_encoder_nodejs.js"),
        import("draco3d/draco_decoder_nodejs.js"),
      ]);
      const encoder = await (encoderJs.default as Create)({ wasmBinary: encoderWasm });
      const decoder = await (decoderJs.default as Create)({ wasmBinary: decoderWasm });
      coder = {
        encode: (task) => attempt(() => encode(encoder, task)),
        decode: (bytes) => attempt(() => decode(decoder, bytes)),
      };
    } finally {
      loading = null;
    }
  })();
  return loading;
}

// A module that has aborted is of no more use.
function attempt<T>(work: () => T): T | string {
  try {
    return work();
  } catch (error) {
    coder = null;
    return `it gave up (${String(error).split("\n")[0]})`;
  }
}

function kindOf(module: DracoModule, kind: string): number {
  if (kind === "position") return module.POSITION;
  if (kind === "color") return module.COLOR;
  if (kind === "texcoord") return module.TEX_COORD;
  return module.GENERIC;
}

function encode(module: DracoModule, task: DracoTask): Uint8Array | string {
  const mesh = new module.Mesh(), builder = new module.MeshBuilder(), out = new module.DracoInt8Array();
  let encoder: DracoModule = null;
  try {
    const faces = new Uint32Array(task.faces.buffer);
    builder.AddFacesToMesh(mesh, faces.length / 3, faces);
    let position = -1;
    for (const { kind, components, type, bytes } of task.attributes) {
      const id: number =
        type === "float"
          ? builder.AddFloatAttributeToMesh(
              mesh, kindOf(module, kind), task.points, components, new Float32Array(bytes.buffer))
          : builder.AddUInt16Attribute(
              mesh, kindOf(module, kind), task.points, components, new Uint16Array(bytes.buffer));
      if (id < 0) return "it takes no such attribute";
      if (type === "uint16" && !builder.SetNormalizedFlagForAttribute(mesh, id, true)) return "it takes no colours";
      if (kind === "position") position = id;
    }
    encoder = new module.ExpertEncoder(mesh);
    encoder.SetEncodingMethod(task.edgebreaker ? module.MESH_EDGEBREAKER_ENCODING : module.MESH_SEQUENTIAL_ENCODING);
    encoder.SetSpeedOptions(0, 0);
    encoder.SetAttributeExplicitQuantization(position, task.bits, 3, task.origin, task.range);
    const size: number = encoder.EncodeToDracoBuffer(false, out);
    if (size <= 0) return "it gives no reason";
    const bytes = new Uint8Array(size);
    for (let i = 0; i < size; ++i) bytes[i] = out.GetValue(i);
    return bytes;
  } finally {
    for (const object of [encoder, out, builder, mesh]) if (object) module.destroy(object);
  }
}

function decode(module: DracoModule, bytes: Uint8Array): DracoMesh | string {
  const decoder = new module.Decoder(), mesh = new module.Mesh();
  try {
    const status = decoder.DecodeArrayToMesh(bytes, bytes.length, mesh);
    if (!status.ok()) return String(status.error_msg()).split("\n")[0] || "broken data";
    const points: number = mesh.num_points();
    const copy = (size: number, fill: (place: number) => boolean): Uint8Array | null => {
      const place: number = module._malloc(size);
      try {
        return fill(place) ? module.HEAPU8.slice(place, place + size) : null;
      } finally {
        module._free(place);
      }
    };
    const faceBytes = 12 * mesh.num_faces();
    const faces = copy(faceBytes, (place) => decoder.GetTrianglesUInt32Array(mesh, faceBytes, place));
    if (!faces) return "it gives no faces";
    const found = new Map<string, Uint8Array>();
    for (let i = 0; i < mesh.num_attributes(); ++i) {
      const a = decoder.GetAttribute(mesh, i), components: number = a.num_components();
      const name = [module.DT_FLOAT32, "float", 4], codes = [module.DT_UINT16, "uint16", 2];
      const type = a.data_type() === name[0] ? name : a.data_type() === codes[0] ? codes : null;
      // A few bytes can declare many components of many points.
      if (!type || components > 4) return "it has an attribute that no container has";
      const size = points * components * type[2];
      const values = copy(size, (place) => decoder.GetAttributeDataArrayForAllPoints(mesh, a, type[0], size, place));
      if (values) found.set([a.unique_id(), a.attribute_type(), components, type[1]].join(), values);
    }
    return {
      points,
      attributes: mesh.num_attributes(),
      faces: new Uint32Array(faces.buffer),
      attribute: (id, kind, components, type) =>
        found.get([id, kindOf(module, kind), components, type].join()) ?? null,
    };
  } finally {
    module.destroy(mesh);
    module.destroy(decoder);
  }
}
