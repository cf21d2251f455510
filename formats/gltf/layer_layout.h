// How a container stores its pixel maps.
#pragma once

namespace imgmesh {

enum class LayerLayout {
    kOff,     ///< without pixel maps
    kExr,     ///< an EXR of face ids and weights, which other programs read
    kCompact  ///< a compact stream of displacements (formats/compact): about a sixth of the bytes
};

/// The media type of the layers, and the ending of their sidecar file's name. Not for kOff.
constexpr const char* media_type(LayerLayout layout) {
    return layout == LayerLayout::kCompact ? "application/x-imgmesh-map" : "image/x-exr";
}
constexpr const char* sidecar_extension(LayerLayout layout) {
    return layout == LayerLayout::kCompact ? ".imgmap" : ".exr";
}

}  // namespace imgmesh
