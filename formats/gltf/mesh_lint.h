// Warnings and infos about a decoded mesh; internal to the validator.
#pragma once

#include "formats/gltf/gltf_asset.h"
#include "formats/gltf/stored_mesh.h"

namespace imgmesh {

class Findings;

/// `mesh` has no errors (base_from_stored). Takes O(F log F) time.
void lint_mesh(const StoredMesh& mesh, const AssetLevel& level, const SourceInfo& source, Findings& findings);

}  // namespace imgmesh
