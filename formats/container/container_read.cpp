#include <algorithm>
#include <cstring>
#include <filesystem>
#include <span>

#include "formats/container/container.h"
#include "formats/container/layers.h"
#include "formats/container/validate.h"
#include "formats/files/atomic_file.h"
#include "formats/files/image_signature.h"
#include "formats/files/one_line.h"
#include "formats/findings/findings.h"
#include "formats/gltf/glb.h"
#include "formats/gltf/gltf_asset.h"
#include "formats/gltf/gltf_names.h"
#include "formats/gltf/gltf_texture.h"
#include "formats/gltf/mesh_lint.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

using Bytes = std::vector<std::uint8_t>;
using View = std::span<const std::uint8_t>;

// Reads files until their total is too large.
class FileReader {
  public:
    explicit FileReader(std::uint64_t max_bytes) : left_(max_bytes) {}

    Bytes read(const std::string& path, FileKind kind) {
        try {
            Bytes bytes = read_file(path, left_, kind);
            left_ -= bytes.size();
            total_ += bytes.size();
            names_.push_back(path);
            return bytes;
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::kBadFile) throw;
            refuse("limits.bytes", error.what());
        }
    }
    std::uint64_t total() const { return total_; }
    const std::vector<std::string>& names() const { return names_; }

  private:
    std::uint64_t left_, total_ = 0;
    std::vector<std::string> names_;
};

View cut(View buffer, const ByteRange& range) {
    return buffer.subspan(range.offset, range.length);  // asset_from_json has checked the range
}

template <typename T>
void copy_to(std::vector<T>& out, View bytes) {
    out.resize(bytes.size() / sizeof(T));
    if (!out.empty()) std::memcpy(out.data(), bytes.data(), out.size() * sizeof(T));
}

StoredMesh load_mesh(const AssetLevel& level, View buffer, Findings& findings) {
    if (level.is_draco)
        return decode_draco_mesh(cut(buffer, level.draco), level.ids, level.vertices, level.faces, findings);
    StoredMesh mesh;
    copy_to(mesh.faces, cut(buffer, level.indices));
    copy_to(mesh.position, cut(buffer, level.positions));
    copy_to(mesh.color, cut(buffer, level.colors));
    copy_to(mesh.hdr, cut(buffer, level.hdr));
    for (const ByteRange& bytes : level.channels) copy_to(mesh.channels.emplace_back(), cut(buffer, bytes));
    copy_to(mesh.texcoord, cut(buffer, level.texcoords));
    return mesh;
}

BaseMesh load_level(const AssetLevel& level, const SourceInfo& source, View buffer, Findings& findings,
                    std::vector<Vec2f>& coords) {
    const StoredMesh mesh = load_mesh(level, buffer, findings);
    const std::string topology = topology_hash(mesh);
    if (topology != level.topology)
        findings.add("mesh.topology", cat("the mesh has the hash ", topology, ", its pixel map was made for ",
                                          level.topology));
    const std::size_t before = findings.errors();
    BaseMesh base = base_from_stored(mesh, findings, layout_of(source).alpha.has_value());
    for (const auto& [u, v] : mesh.texcoord) coords.emplace_back(u, v);
    if (findings.collects() && findings.errors() == before) lint_mesh(mesh, level, source, findings);
    return base;
}

StoredLayers load_layers(const Asset& asset, View bytes, Findings& findings) {
    ExpectedLayers expected{asset.source.width, asset.source.height, {}, {}, asset.source.has_mask};
    for (std::size_t k = 0; k < asset.levels.size(); ++k) {
        const AssetLevel& level = asset.levels[k];
        expected.parts.push_back(level_name(k));
        expected.faces.push_back(level.is_sound ? level.faces : kNone);
    }
    return {asset.layout, bytes, expected, findings};
}

void add_level_facts(const Asset& asset, View buffer, ContainerFacts& facts) {
    for (const AssetLevel& level : asset.levels) facts.mesh_bytes += stored_bytes(level);
    if (asset.levels[0].is_draco) facts.draco = draco_mode(cut(buffer, asset.levels[0].draco));
}

enum class Wanted { kAll, kMeshes };

// Returns all levels whose meshes and parts can be checked.
void read_levels(const Asset& asset, View buffer, StoredLayers& layers, Wanted wanted, Findings& findings,
                 MeshImage& image, std::vector<std::vector<Vec2f>>& coords) {
    for (std::size_t k = 0; k < asset.levels.size(); ++k) {
        const AssetLevel& level = asset.levels[k];
        BaseMesh mesh;
        coords.emplace_back();
        const std::size_t before = findings.errors();
        if (level.is_sound)
            findings.attempt(asset.places[k].pointer, [&] {
                mesh = load_level(level, asset.source, buffer, findings, coords.back());
            });
        // A validator goes on: no pixel is to be found on a mesh whose faces point anywhere.
        if (findings.errors() > before) mesh = {};
        if (k >= layers.size()) continue;
        const bool other_mesh =
            level.is_sound && !layers.topology(k).empty() && layers.topology(k) != level.topology;
        if (other_mesh)
            findings.add("layers.topology",
                         cat(layers.name(k), " was made for a mesh of hash ", layers.topology(k),
                             ", the mesh has ", level.topology),
                         at_part(layers.name(k)));
        PixelMap map =
            other_mesh || wanted == Wanted::kMeshes ? PixelMap() : layers.take_map(k, mesh, findings);
        image.levels.push_back({std::move(mesh), std::move(map), level.error});
    }
}

// A texture is useless if a level has no coordinates for it.
void read_texture(const Asset& asset, View buffer, Findings& findings, Container& container) {
    Texture& texture = container.texture;
    const View picture = cut(buffer, asset.texture);
    const std::string type = picture_type(picture);
    if (type != asset.texture_type)
        findings.add("texture.data", cat("the texture is no file of type ", asset.texture_type),
                     at_pointer("/images"));
    if (type.empty() || !std::all_of(asset.levels.begin(), asset.levels.end(),
                                     [](const AssetLevel& level) { return level.has_texcoords; })) {
        texture.coords.clear();
        return;
    }
    texture.picture.assign(picture.begin(), picture.end());
    container.facts.texture_bytes = picture.size();
}

// Refuses a file of another kind.
[[noreturn]] void refuse_other(const std::string& path, const std::string& what, const Findings& findings) {
    if (findings.collects()) refuse("json.syntax", what);
    throw Error(ErrorKind::kBadFile, cat(path, ": ", what));
}

Container read(const std::string& path, const ContainerLimits& limits, Wanted wanted, Findings& findings) {
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    FileReader files(limits.max_bytes);
    const Bytes main = files.read(path, FileKind::kStream);
    if (const std::string_view image = image_signature(main); !image.empty()) {
        const std::string what = cat("is ", image == "EXR" || image == "HDR" ? "an " : "a ", image,
                                     " image, not a container; imgmesh-build makes one of it");
        refuse_other(path, what, findings);
    }
    if (has_coded_signature(main))
        refuse_other(path, "is a coded picture, not a container; imgmesh-decode draws and describes it",
                     findings);
    GlbView glb{{reinterpret_cast<const char*>(main.data()), main.size()}, {}};
    if (is_glb(main)) glb = unpack_glb(main, findings);
    Asset asset = asset_from_json(glb.json, limits, findings);

    Bytes buffer_file, layer_file;
    View buffer = glb.binary, layers;
    if (!asset.buffer_name.empty())
        buffer = buffer_file = files.read((folder / asset.buffer_name).string(), FileKind::kRegular);
    const bool is_whole = asset.has_buffer && findings.attempt("/buffers/0", [&] {
        if (asset.buffer_length > buffer.size())
            refuse("gltf.buffer",
                   cat("the buffer has ", buffer.size(), " bytes, its byteLength is ", asset.buffer_length));
    });
    // The binary chunk of a .glb is padded to a multiple of four.
    if (is_whole && buffer.size() - asset.buffer_length > (asset.buffer_name.empty() ? 3u : 0u))
        findings.add("gltf.buffer_tail",
                     cat("the buffer has ", buffer.size(), " bytes, its byteLength is ", asset.buffer_length),
                     at_pointer("/buffers/0/byteLength"));
    if (!asset.layers_name.empty())
        layers = layer_file = files.read((folder / asset.layers_name).string(), FileKind::kRegular);
    else if (is_whole && asset.has_layers)
        layers = cut(buffer, asset.layers);

    Container container;
    container.facts.version = asset.version;
    container.facts.files = files.names();
    container.facts.total_bytes = files.total();
    container.facts.layout = asset.layout;
    container.facts.layer_bytes = layers.size();
    // Pixels come first: their number bounds what the meshes may claim. So a validator does not decode meshes
    // either if the layers are not read; earlier findings say why.
    StoredLayers maps;
    if (!asset.has_levels || !asset.has_layers || !(is_whole || !asset.layers_name.empty())) return container;
    if (!findings.attempt(cat("/extensions/", kPixelMap, "/layers"),
                          [&] { maps = load_layers(asset, layers, findings); }))
        return container;
    if (!is_whole) return container;
    MeshImage& image = container.mesh_image;
    read_levels(asset, buffer, maps, wanted, findings, image, container.texture.coords);
    if (findings.errors() > 0) return container;
    read_texture(asset, buffer, findings, container);
    add_level_facts(asset, buffer, container.facts);
    if (wanted == Wanted::kAll) image.visits = maps.take_visits();
    container.metadata = std::move(asset.metadata);
    image.source = std::move(asset.source);
    image.generator = std::move(asset.generator);
    image.parameters = std::move(asset.parameters);
    return container;
}

Container read_strictly(const std::string& path, const ContainerLimits& limits, Wanted wanted) {
    try {
        Findings findings = Findings::strict();
        return read(path, limits, wanted, findings);
    } catch (const FindingError& finding) {
        // Names from the file are quoted unchanged; the message stays one line.
        throw Error(finding.error_kind(),
                    cat(path, ": [", finding.code(), "] ", printable(finding.what(), ' ')));
    }
}

}  // namespace

Container read_container(const std::string& path, const ContainerLimits& limits) {
    return read_strictly(path, limits, Wanted::kAll);
}

MeshImage read_meshes(const std::string& path, const ContainerLimits& limits) {
    return read_strictly(path, limits, Wanted::kMeshes).mesh_image;
}

std::vector<Issue> validate_container(const std::string& path, const ContainerLimits& limits) {
    Findings findings = Findings::collecting();
    findings.attempt("", [&] { read(path, limits, Wanted::kAll, findings); });
    return std::move(findings.issues());
}

}  // namespace imgmesh
