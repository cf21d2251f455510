// Warnings and infos about a container's JSON; internal to the validator.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "formats/gltf/gltf_asset.h"

namespace imgmesh {

class Findings;

/// Reports what will go wrong in viewers, and what imgmesh ignores. `asset` is what could be read of
/// `document`, an object of any content.
void lint_gltf(const nlohmann::json& document, const Asset& asset, Findings& findings);

}  // namespace imgmesh
