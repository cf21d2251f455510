// Distributions of the quality of a mesh and of a map over their parts; metrics.h has means and
// extremes.
#pragma once

#include "libcore/mesh/mesh_image.h"
#include "libcore/metrics/distribution.h"

namespace imgmesh {

/// The bins are fixed, so that histograms of different meshes can be compared.
inline constexpr Bins kValenceBins{1.5, 12.5, 11};  ///< one bin for each whole number, 2 to 12
inline constexpr Bins kRatioBins{1, 5, 20};         ///< edge ratio, aspect ratio
inline constexpr Bins kRadiusEdgeBins{0.5, 4.5, 20};
inline constexpr Bins kUnitBins{0, 1, 20};           ///< radius ratio, shape
inline constexpr Bins kAngleBins{0, 60, 20};         ///< [degrees]
inline constexpr Bins kJumpBins{0, 5, 20};           ///< [px]
inline constexpr Bins kDisplacementBins{0, 10, 20};  ///< [px]
inline constexpr Bins kAreaBins{0, 4, 20};

/// Distributions of the measures of triangle_shape.h over the faces of positive area.
struct MeshDistributions {
    Distribution valence;  ///< edges at a vertex, over the vertices in use
    Distribution edge_ratio, aspect_ratio, radius_ratio, radius_edge_ratio, shape, min_angle_deg;
};

/// Measures any mesh whose face corners are < vertex_count(). Takes O(F log F) time.
MeshDistributions mesh_distributions(const BaseMesh& mesh);

/// Distributions over the pixels with a face of the mesh.
struct MapDistributions {
    Distribution jump;          ///< distance between the images of two 4-neighbours [px]; 1 in the image
    Distribution displacement;  ///< distance between a pixel and its image [px]
    /// Pixels of a face's patch / area of the face [1/px^2], over the faces of positive area: how much the
    /// map stretches each face. It is 0 for a face without pixels, and about 1 for the identity.
    Distribution patch_per_area;
    std::int64_t empty_patches = 0;  ///< faces without pixels
};

/// Measures any map of finite weights. Takes O(W H + F) time.
MapDistributions map_distributions(const BaseMesh& mesh, const PixelMap& map);

}  // namespace imgmesh
