#include <algorithm>
#include <cstring>
#include <filesystem>
#include <span>

#include "formats/atomic_file.h"
#include "formats/container.h"
#include "formats/exr_layers.h"
#include "formats/finding_codes.h"
#include "formats/glb.h"
#include "formats/gltf_asset.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

using Bytes = std::vector<std::uint8_t>;
using View = std::span<const std::uint8_t>;

// Reads files until all together are too many bytes.
class FileReader {
  public:
    explicit FileReader(std::uint64_t max_bytes) : left_(max_bytes) {}

    Bytes read(const std::string& path) {
        try {
            Bytes bytes = read_file(path, left_);
            left_ -= bytes.size();
            total_ += bytes.size();
            names_.push_back(path);
            return bytes;
        } catch (const Error& error) {
            if (error.code() != ErrorCode::kBadFile) throw;
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
    std::memcpy(out.data(), bytes.data(), bytes.size());
}

StoredMesh load_mesh(const AssetLevel& level, View buffer) {
    if (level.is_draco)
        return decode_draco_mesh(cut(buffer, level.draco), level.ids, level.vertices, level.faces);
    StoredMesh mesh;
    copy_to(mesh.faces, cut(buffer, level.indices));
    copy_to(mesh.position, cut(buffer, level.positions));
    copy_to(mesh.color, cut(buffer, level.colors));
    return mesh;
}

BaseMesh load_level(const AssetLevel& level, View buffer) {
    const StoredMesh mesh = load_mesh(level, buffer);
    const std::string topology = topology_hash(mesh);
    if (topology != level.topology)
        refuse("mesh.topology",
               cat("the mesh has the hash ", topology, ", its pixel map was made for ", level.topology));
    return base_from_stored(mesh);
}

std::vector<LayerPart> load_layers(const Asset& asset, View bytes) {
    ExpectedLayers expected{asset.source.width, asset.source.height, {}, {}, asset.source.has_mask};
    for (std::size_t k = 0; k < asset.levels.size(); ++k) {
        expected.parts.push_back(level_name(k));
        expected.faces.push_back(asset.levels[k].faces);
    }
    return decode_exr_layers(bytes, expected);
}

ContainerFacts facts_of(const Asset& asset, View buffer) {
    ContainerFacts facts;
    facts.version = asset.version;
    for (const AssetLevel& level : asset.levels)
        facts.mesh_bytes +=
            level.draco.length + level.indices.length + level.positions.length + level.colors.length;
    if (asset.levels[0].is_draco) facts.draco = draco_mode(cut(buffer, asset.levels[0].draco));
    return facts;
}

Container read(const std::string& path, const ContainerLimits& limits) {
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    FileReader files(limits.max_bytes);
    const Bytes main = files.read(path);
    GlbView glb{{reinterpret_cast<const char*>(main.data()), main.size()}, {}};
    if (is_glb(main)) glb = unpack_glb(main);
    Asset asset = asset_from_json(glb.json, limits);

    Bytes buffer_file, layer_file;
    View buffer = glb.binary, layers;
    if (!asset.buffer_name.empty()) buffer = buffer_file = files.read((folder / asset.buffer_name).string());
    if (asset.buffer_length > buffer.size())
        refuse("gltf.buffer",
               cat("the buffer has ", buffer.size(), " bytes, its byteLength is ", asset.buffer_length));
    if (asset.layers_name.empty())
        layers = cut(buffer, asset.layers);
    else
        layers = layer_file = files.read((folder / asset.layers_name).string());

    Container container;
    container.facts = facts_of(asset, buffer);
    container.facts.files = files.names();
    container.facts.total_bytes = files.total();
    container.facts.layer_bytes = layers.size();
    MeshImage& image = container.mesh_image;
    // Pixels come first: that so many are there bounds what the meshes may claim.
    std::vector<LayerPart> parts = load_layers(asset, layers);
    for (std::size_t k = 0; k < parts.size(); ++k) {
        const AssetLevel& level = asset.levels[k];
        image.levels.push_back({load_level(level, buffer), std::move(parts[k].map), level.error});
        if (!parts[k].topology.empty() && parts[k].topology != level.topology)
            refuse("layers.topology", cat(parts[k].name, " was made for a mesh of hash ", parts[k].topology,
                                          ", the mesh has ", level.topology));
    }
    image.visits = std::move(parts[0].visits);
    image.source = std::move(asset.source);
    image.generator = std::move(asset.generator);
    image.parameters = std::move(asset.parameters);
    return container;
}

}  // namespace

Container read_container(const std::string& path, const ContainerLimits& limits) {
    try {
        return read(path, limits);
    } catch (const FindingError& finding) {
        std::string text = finding.what();
        // Names from the file are quoted as they are; the message stays one line.
        std::replace_if(
            text.begin(), text.end(), [](unsigned char c) { return c < 32 || c == 127; }, ' ');
        throw Error(finding.error_code(), cat(path, ": [", finding.code(), "] ", text));
    }
}

}  // namespace imgmesh
