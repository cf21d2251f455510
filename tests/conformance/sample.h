// A smallest container in its parts, each of which can be broken before it is written.
#pragma once

#include <ImfHeader.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "formats/compact/compact_layers.h"
#include "formats/container/container.h"
#include "formats/exr/exr_layers.h"
#include "formats/gltf/gltf_asset.h"
#include "formats/gltf/stored_mesh.h"

namespace imgmesh::conformance {

using Bytes = std::vector<std::uint8_t>;
using nlohmann::json;

/// An EXR of one part, written by OpenEXR itself, so that it can have what our writer never writes.
struct Exr {
    Imf::Header header;
    std::vector<std::uint32_t> face;
    std::vector<float> u, v;
    bool tiled = false;

    Exr(int width, int height, const std::string& topology);
    Bytes bytes() const;
};

/// An image of 3 x 3 pixels, all in face 0 or 1 of a square of two faces, on each of `levels` levels. With
/// compact layers all pixels lie where they are in the image.
struct Sample {
    Asset asset;
    std::vector<StoredMesh> meshes;
    std::vector<LayerPart> parts;
    std::vector<DracoMode> modes;
    Bytes texture;  ///< empty for none
    // What is done to the result before it is written.
    std::function<void(Exr&)> edit_exr;              ///< of one level; its EXR is written by OpenEXR then
    std::function<void(CompactPart&)> edit_compact;  ///< of each level; for asset.layout kCompact
    std::function<void(json&)> edit_json;
    std::function<void(std::string&)> edit_text;
    std::function<void(Bytes&)> edit_bin, edit_layers, edit_glb;

    Sample(int levels = 1, DracoMode mode = DracoMode::kOff);
    void add_texture();
    /// x.gltf, x.bin and x.exr or x.imgmap, or x.glb, in a folder that is made.
    void write(const std::filesystem::path& folder, bool glb) const;
};

void write_bytes(const std::filesystem::path& path, const Bytes& bytes);

}  // namespace imgmesh::conformance
