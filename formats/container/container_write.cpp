#include <algorithm>
#include <array>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include "formats/container/container.h"
#include "formats/container/layers.h"
#include "formats/container/sidecar_file.h"
#include "formats/files/atomic_file.h"
#include "formats/files/extension.h"
#include "formats/gltf/glb.h"
#include "formats/gltf/gltf_asset.h"
#include "formats/gltf/gltf_texture.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

constexpr const char* kVersion = "1.1";

void check_writable(const MeshImage& image, const Texture& texture, bool with_layers) {
    const SourceInfo& source = image.source;
    const auto pixels = static_cast<std::size_t>(source.width) * static_cast<std::size_t>(source.height);
    bool fits = source.width >= 1 && source.height >= 1 &&
                std::max(source.width, source.height) <= kMaxCoordinate && !image.levels.empty() &&
                (image.visits.empty() || image.visits.size() == pixels);
    for (const Level& level : image.levels) {
        if (!with_layers && level.map.empty()) continue;
        fits = fits && level.map.width == source.width && level.map.height == source.height &&
               level.map.size() == pixels;
        for (const PixelCoord& c : level.map)
            fits = fits && (c.face == kNone ? source.has_mask : c.face < level.mesh.faces.size());
    }
    if (!texture.picture.empty()) {
        fits = fits && !picture_type(texture.picture).empty() && texture.coords.size() == image.levels.size();
        for (std::size_t k = 0; fits && k < image.levels.size(); ++k)
            fits = texture.coords[k].size() == image.levels[k].mesh.vertex_count();
    }
    if (!fits)
        throw Error(ErrorKind::kInternal, "cannot store the mesh image: its parts do not fit each other");
}

// What a reader gets of a level whose mesh Draco's coder has changed.
struct StoredLevel {
    BaseMesh mesh;  // positions and faces alone
    PixelMap map;
};

BaseMesh shape_of(const StoredMesh& mesh) {
    BaseMesh shape{0, {}, {}, mesh.faces};
    for (const auto& [x, y, z] : mesh.position) shape.position.emplace_back(x, -y);
    return shape;
}

// Stores the mesh of `level` in `buffer`. Draco's coder changes it: `stored` is then what a reader will get.
// `coords` are those of its texture; empty if there is none.
AssetLevel store_level(const Level& level, const StoredLayout& layout, std::span<const Vec2f> coords,
                       DracoMode mode, MeshoptWriter* meshopt, std::vector<std::uint8_t>& buffer,
                       StoredLevel& stored) {
    StoredMesh mesh = stored_from_base(level.mesh, layout);
    for (const Vec2f& c : coords) mesh.texcoord.push_back({c.x(), c.y()});
    AssetLevel out;
    out.has_texcoords = !coords.empty();
    if (mode == DracoMode::kOff) {
        if (meshopt) mesh = ordered_for_meshopt(mesh);
        const auto append = [&](const auto& values) {
            return meshopt ? meshopt->add(values) : append_values(buffer, values);
        };
        out.indices = append(mesh.faces);
        out.positions = append(mesh.position);
        if (layout.color) out.colors = append(mesh.color);
        if (layout.hdr) out.hdr = append(mesh.hdr);
        for (const std::vector<float>& channel : mesh.channels) out.channels.push_back(append(channel));
        if (out.has_texcoords) out.texcoords = append(mesh.texcoord);
    } else {
        DracoMesh draco = encode_draco_mesh(mesh, mode);
        out.is_draco = true;
        out.draco = append_values(buffer, draco.bytes);
        stored.map = level.map;
        remap_pixels(match_faces(mesh, draco.decoded), stored.map);
        mesh = std::move(draco.decoded);
        stored.mesh = shape_of(mesh);
    }
    out.vertices = mesh.position.size();
    out.faces = mesh.faces.size();
    out.error = level.error;
    out.topology = topology_hash(mesh);
    out.bounds = bounds_of(mesh.position);
    return out;
}

enum class FileVariant { kGlb, kGltf };

FileVariant variant_of(const std::string& path) {
    const std::string extension = lower_extension(path);
    if (extension == ".glb") return FileVariant::kGlb;
    if (extension == ".gltf") return FileVariant::kGltf;
    throw Error(ErrorKind::kBadArgument, cat(path, ": a container's name ends with .glb or .gltf"));
}

// Throws Error(kUnsupported) if the buffer is too long. `apart` is what a .gltf would keep in another file.
void check_length(const std::string& path, std::uint64_t bytes, std::uint64_t apart, const char* need,
                  const ContainerOptions& options) {
    if (bytes <= options.max_buffer_bytes) return;
    const bool fits_apart = bytes - apart <= options.max_buffer_bytes;
    throw Error(
        ErrorKind::kUnsupported,
        cat(path, ": its buffer ", need, ' ', bytes, " bytes, and has at most ", options.max_buffer_bytes,
            fits_apart ? "; a .gltf keeps the pixel maps in a file of any size"
                       : "; fewer vertices or another compression of the meshes make it shorter"));
}

// The layers are most of the file, so they are written without a copy.
void write_glb(const std::string& path, Asset& asset, const std::vector<std::uint8_t>& buffer,
               const std::vector<std::uint8_t>& layers, bool overwrite) {
    constexpr std::array<std::uint8_t, 3> kZeros = {};
    const std::size_t padding = (4 - layers.size() % 4) % 4;
    if (asset.has_layers) asset.layers = {buffer.size(), layers.size()};
    asset.buffer_length = buffer.size() + layers.size() + padding;
    const std::vector<std::uint8_t> head = glb_head(json_from_asset(asset), asset.buffer_length);
    AtomicFile file(path, overwrite);
    const std::array<std::span<const std::uint8_t>, 4> parts = {head, buffer, layers,
                                                                std::span(kZeros).first(padding)};
    file.write_parts(parts);
    file.commit();
}

// The rename of the .gltf switches to the new container. Until then the files of the old one stay, and only
// then are they removed. A crash in between leaves files that nothing refers to; a signal waits until all is
// done.
std::vector<std::string> write_gltf(const std::string& path, Asset& asset,
                                    const std::vector<std::uint8_t>& buffer,
                                    const std::vector<std::uint8_t>& layers,
                                    const ContainerOptions& options) {
    // Another writer of the same name waits: each finds the other's files whole, and leaves none behind.
    const FolderLock lock(std::filesystem::path(path).parent_path().string());
    const std::vector<std::string> old_files = sidecars_of(path);
    // Declared first, so it ends after the files below: a useless one must be removed before a signal.
    std::optional<SignalBlocker> switch_over;
    AtomicFile gltf(path, options.overwrite);
    SidecarFile bin(path, ".bin", buffer);
    std::optional<SidecarFile> maps;
    if (asset.has_layers) maps.emplace(path, sidecar_extension(asset.layout), layers);
    asset.buffer_name = bin.name();
    if (maps) asset.layers_name = maps->name();
    asset.buffer_length = buffer.size();
    const std::string json = json_from_asset(asset);
    gltf.write({reinterpret_cast<const std::uint8_t*>(json.data()), json.size()});
    switch_over.emplace();
    bin.place();
    if (maps) maps->place();
    gltf.place();  // at once, among whatever files: its companions are in their place
    gltf.keep();
    bin.keep();
    if (maps) maps->keep();
    for (const std::string& file : old_files) {
        const std::string name = std::filesystem::path(file).filename().string();
        std::error_code error;  // a file left behind does no harm
        const bool kept = std::any_of(
            options.keep.begin(), options.keep.end(),
            [&](const std::string& other) { return std::filesystem::equivalent(file, other, error); });
        if (!kept && name != asset.buffer_name && name != asset.layers_name)
            std::filesystem::remove(file, error);
    }
    std::vector<std::string> files = {path};
    for (const std::string& name : {asset.buffer_name, asset.layers_name})
        if (!name.empty()) files.push_back(std::filesystem::path(path).replace_filename(name).string());
    return files;
}

}  // namespace

std::vector<std::vector<Vec2f>> texture_coords(const MeshImage& mesh_image) {
    const Vec2f size(static_cast<float>(mesh_image.source.width),
                     static_cast<float>(mesh_image.source.height));
    std::vector<std::vector<Vec2f>> coords;
    for (const Level& level : mesh_image.levels) {
        std::vector<Vec2f>& of_level = coords.emplace_back();
        for (const Vec2f& p : level.mesh.position)
            of_level.emplace_back((p + Vec2f(0.5f, 0.5f)).cwiseQuotient(size));
    }
    return coords;
}

std::vector<std::string> container_files(const std::string& path, LayerLayout layers) {
    if (variant_of(path) == FileVariant::kGlb) return {path};
    const std::string stem = std::filesystem::path(path).replace_extension().string();
    if (layers == LayerLayout::kOff) return {path, stem + ".bin"};
    return {path, stem + ".bin", stem + sidecar_extension(layers)};
}

std::string check_buffer(const std::string& path, const ContainerPlan& plan,
                         const ContainerOptions& options) {
    // A position and a channel. How far Draco and deflate go depends on the image: a flat one takes nothing.
    constexpr std::uint64_t kVertexBytes = 12 + 4;
    const double usual_pixel_bytes = options.layers == LayerLayout::kCompact ? 0.5 : 3;
    const bool plain = options.draco == DracoMode::kOff && !options.meshopt;
    const std::uint64_t least = options.texture.picture.size() +
                                (plain ? kVertexBytes * static_cast<std::uint64_t>(plan.vertices) : 0);
    const bool has_maps = variant_of(path) == FileVariant::kGlb && options.layers != LayerLayout::kOff;
    check_length(path, least, 0, "will need at least", options);
    const std::uint64_t usual =
        least +
        (has_maps ? static_cast<std::uint64_t>(usual_pixel_bytes * static_cast<double>(plan.pixels)) : 0);
    if (usual <= options.max_buffer_bytes) return "";
    return cat(path, ": will probably be too long for a .glb: about ", usual, " bytes, at most ",
               options.max_buffer_bytes, "; a .gltf keeps the pixel maps in a file of any size");
}

WrittenContainer write_container(const std::string& path, const MeshImage& mesh_image,
                                 const ContainerOptions& options) {
    const FileVariant variant = variant_of(path);
    const bool with_layers = options.layers != LayerLayout::kOff;
    if (options.meshopt && with_layers)
        throw Error(ErrorKind::kInternal, "a container with pixel maps cannot have meshopt compression");
    check_writable(mesh_image, options.texture, with_layers);
    const SourceInfo& source = mesh_image.source;
    const std::string fault = exr_metadata_fault(options.metadata, source.width, source.height);
    if (!fault.empty()) throw Error(ErrorKind::kInternal, cat("cannot store the metadata: ", fault));
    Asset asset;
    asset.version = kVersion;
    asset.source = mesh_image.source;
    asset.metadata = options.metadata;
    asset.generator = mesh_image.generator;
    asset.parameters = mesh_image.parameters;
    std::vector<std::uint8_t> buffer;
    std::vector<LayerSource> parts;
    std::deque<StoredLevel> rewritten;
    const Texture& texture = options.texture;
    const DracoMode draco = options.meshopt ? DracoMode::kOff : options.draco;
    MeshoptWriter meshopt(buffer);
    for (const Level& level : mesh_image.levels) {
        std::span<const Vec2f> coords;
        if (!texture.picture.empty()) coords = texture.coords[asset.levels.size()];
        StoredLevel& stored = rewritten.emplace_back();
        asset.levels.push_back(store_level(level, layout_of(asset.source), coords, draco,
                                           options.meshopt ? &meshopt : nullptr, buffer, stored));
        const bool changed = draco != DracoMode::kOff;
        parts.push_back(
            {{level_name(parts.size()), changed ? &stored.map : &level.map, {}, asset.levels.back().topology},
             changed ? &stored.mesh : &level.mesh});
    }
    asset.meshopt = meshopt.views();
    asset.fallback_length = meshopt.fallback_length();
    std::uint64_t mesh_bytes = 0;
    for (const AssetLevel& level : asset.levels) mesh_bytes += stored_bytes(level);
    if (options.meshopt) mesh_bytes = buffer.size();  // and not those of the fallback
    parts.front().view.visits = mesh_image.visits;
    if (!texture.picture.empty()) {
        asset.texture_type = picture_type(texture.picture);
        asset.texture = append_values(buffer, texture.picture);
    }
    asset.has_layers = with_layers;
    if (with_layers) asset.layout = options.layers;
    const std::vector<std::uint8_t> layers =
        with_layers ? encode_layers(options.layers, parts) : std::vector<std::uint8_t>();
    const std::uint64_t apart = variant == FileVariant::kGlb ? layers.size() : 0;
    constexpr std::uint64_t kPadding = 3;
    check_length(path, buffer.size() + apart + (apart > 0 ? kPadding : 0), apart + kPadding, "needs",
                 options);
    if (variant == FileVariant::kGltf)
        return {write_gltf(path, asset, buffer, layers, options), mesh_bytes, layers.size()};
    write_glb(path, asset, buffer, layers, options.overwrite);
    return {{path}, mesh_bytes, layers.size()};
}

}  // namespace imgmesh
