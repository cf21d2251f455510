// How good a mesh and a pixel map are. For images against each other see compare_images.h.
#pragma once

#include <cstdint>
#include <vector>

#include "libcore/image/image.h"
#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

/// Counts and the shape of the triangles of a mesh (measures as in triangle_shape.h). Means are over the
/// faces of positive area; the least values count every other face as 0. All figures of an empty mesh are 0.
struct MeshQuality {
    std::int64_t vertices = 0;  ///< all vertices, also those without a face
    std::int64_t faces = 0;
    std::int64_t edges = 0;
    std::int64_t boundary_edges = 0;  ///< edges with one face
    std::int64_t components = 0;      ///< connected components of faces that share edges
    std::int64_t euler = 0;           ///< V - E + F, counting only vertices in use
    /// Edges with more than two faces, or with two faces that run the same way.
    std::int64_t nonmanifold_edges = 0;
    std::int64_t nonmanifold_vertices = 0;  ///< vertices whose faces form more than one fan
    std::int64_t flipped_faces = 0;         ///< signed_area2 <= 0
    double area = 0;                        ///< sum of signed areas [px^2]
    double mean_valence = 0;                ///< edges at a vertex, over vertices in use
    double mean_edge_ratio = 0;             ///< longest edge / shortest edge of a face (1 is best)
    double mean_radius_ratio = 0;           ///< 2 inradius / circumradius (1 is best)
    double mean_shape = 0;                  ///< q = 4 sqrt(3) area / sum of squared edges (1 is best)
    double min_shape = 0;
    double min_angle_deg = 0;
};

/// Measures any mesh whose face corners are < vertex_count(), manifold or not. Takes O(F log F) time.
MeshQuality mesh_quality(const BaseMesh& mesh);

/// The pixel map as a mapping into the plane. A pixel's image is the place where the map puts it.
struct MapQuality {
    std::int64_t pixels = 0;           ///< pixels inside the mask, or all without one
    std::int64_t unmapped = 0;         ///< those without a face of the mesh (kNone or out of range)
    std::int64_t outside_simplex = 0;  ///< those with a weight below 0 or not finite
    /// Triangles with area <= 0, out of the four of each 2 x 2 cell (both diagonals) whose pixels are mapped.
    std::int64_t flipped_triangles = 0;
    double min_area2 = 0;  ///< least twice-area of these triangles [px^2]; 1 in the source, or if none
    double max_jump = 0;   ///< largest distance between the images of two 4-neighbours [px]
    double mean_displacement = 0;  ///< mean distance between a mapped pixel and its image [px]
    double max_displacement = 0;
};

/// Measures any map, valid or not. If has_mask, pixels with face kNone are outside the image, not unmapped.
/// Takes O(pixels) time.
MapQuality map_quality(const BaseMesh& mesh, const PixelMap& map, bool has_mask = false);

/// Returns where each pixel lands: the positions of the map in `mesh`, width * height. They are NaN if the
/// face is kNone or out of range.
std::vector<Vec2d> mapped_positions(const BaseMesh& mesh, const PixelMap& map);

/// The error of a reconstruction. Returns the root mean square, over the pixels, of the Euclidean distance in
/// feature space between the map's interpolated features and `reference`. Pixels with face kNone are left
/// out; the result is 0 if all are. Face ids must be valid. Throws Error(kBadArgument) if sizes or channels
/// differ.
double map_rms(const BaseMesh& mesh, const PixelMap& map, const FeatureImage& reference);

/// The same for a single feature.
double feature_rms(const BaseMesh& mesh, const PixelMap& map, const FeatureImage& reference, int feature);

}  // namespace imgmesh
