// Reads the members of IMGMESH_pixel_map; internal to the reader. All functions throw FindingError.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "formats/gltf/gltf_asset.h"

namespace imgmesh {

/// Reads the root's "image"; its size is within the limits.
SourceInfo read_image_member(const nlohmann::json& image, const ContainerLimits& limits);

/// Reads the image's "metadata", which may be missing.
ExrMetadata read_metadata_member(const nlohmann::json& image, const SourceInfo& source);

/// Reads the root's "build" into generator and parameters.
void read_build_member(const nlohmann::json& build, Asset& asset);

/// Reads a node's extension: counts within the limits, error, topology.
AssetLevel read_level_member(const nlohmann::json& extension, const SourceInfo& source,
                             const ContainerLimits& limits);

}  // namespace imgmesh
