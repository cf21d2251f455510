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

/// Returns "image/png" or "image/jpeg" by the first bytes; empty for anything else.
std::string picture_type(std::span<const std::uint8_t> bytes);

/// Makes material 0 show the image in bufferView `view`.
void add_texture(nlohmann::json& document, int view, const std::string& type);

/// The place of a texture's image.
struct TextureView {
    std::uint64_t view = 0;
    std::string type;  ///< "image/png" or "image/jpeg"
};

/// Returns the texture of a mesh's first primitive, as add_texture() makes it. Returns none if there is no
/// texture, or one of another kind (a file, another format), which only viewers use. Throws FindingError for
/// an index that is not a number or beyond its array.
std::optional<TextureView> texture_view(const nlohmann::json& document, std::uint64_t mesh);

/// Reports whether viewers show a level's texture unchanged. `level` is sound, and so is what texture_view()
/// reads.
void lint_texture(const nlohmann::json& document, const Asset& asset, std::size_t level, Findings& findings);

}  // namespace imgmesh
