// The pixel maps of a container in either layout. Internal to the container.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/exr/exr_layers.h"
#include "formats/gltf/layer_layout.h"
#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/displacements.h"

namespace imgmesh {

class Findings;

/// A level's pixel map and the mesh for which it is.
struct LayerSource {
    LayerView view;
    const BaseMesh* mesh;  ///< its positions and faces; only for the compact layout
};

/// Encodes the layers; `layout` is not kOff. Throws Error(kUnsupported) for a map that has no compact form,
/// and as encode_exr_layers() does.
std::vector<std::uint8_t> encode_layers(LayerLayout layout, const std::vector<LayerSource>& levels);

/// The layers of a container, decoded as far as that is possible without its meshes.
class StoredLayers {
  public:
    StoredLayers() = default;
    /// Decodes and checks. Safe for any bytes; see decode_exr_layers() and decode_compact_layers().
    StoredLayers(LayerLayout layout, std::span<const std::uint8_t> bytes, const ExpectedLayers& expected,
                 Findings& findings);

    std::size_t size() const { return parts_.size(); }
    const std::string& name(std::size_t level) const { return parts_[level].name; }
    const std::string& topology(std::size_t level) const { return parts_[level].topology; }
    std::vector<Id> take_visits() { return std::move(parts_.at(0).visits); }

    /// Returns the pixel map of a level, whose mesh is needed for the compact layout; empty() if the part was
    /// found broken. Adds a finding for a pixel that lies on no face.
    PixelMap take_map(std::size_t level, const BaseMesh& mesh, Findings& findings);

  private:
    std::vector<LayerPart> parts_;
    std::vector<Displacements> places_;  ///< of each part; empty() for an EXR
};

}  // namespace imgmesh
