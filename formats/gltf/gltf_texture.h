// The image on the meshes, in the glTF document: material, texture, image; see docs/format.md.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>

namespace imgmesh {

class Findings;
struct Asset;

/// "image/png" or "image/jpeg", by the first bytes; empty for anything else.
std::string picture_type(std::span<const std::uint8_t> bytes);

/// Makes material 0 show the image in bufferView `view`. `cut_out`: where its alpha is below 1/2, nothing
/// is drawn.
void add_texture(nlohmann::json& document, int view, const std::string& type, bool cut_out);

/// Where a texture's image is.
struct TextureView {
    std::uint64_t view = 0;
    std::string type;  ///< "image/png" or "image/jpeg"
};

/// The texture of a mesh's first primitive, as add_texture makes it; none where there is no texture, or one
/// of another kind (a file beside, another format), which only viewers look at. Throws FindingError for an
/// index that is none or beyond its array.
std::optional<TextureView> texture_view(const nlohmann::json& document, std::uint64_t mesh);

/// What a validator says of a level's texture: whether viewers show it as it is. `level` is sound, and so
/// is what texture_view looks at.
void lint_texture(const nlohmann::json& document, const Asset& asset, std::size_t level, Findings& findings);

}  // namespace imgmesh
