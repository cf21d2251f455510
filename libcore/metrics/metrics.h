// Figures of merit: how good a mesh, a map, a reconstruction is.
#pragma once

#include <cstdint>

#include "libcore/image/image.h"
#include "libcore/param/mesh_image.h"

namespace imgmesh {

/// Shape of the triangles of a mesh.
struct MeshQuality {
    std::int64_t vertices = 0;
    std::int64_t faces = 0;
    std::int64_t edges = 0;
    std::int64_t boundary_edges = 0;
    std::int64_t components = 0;  ///< connected components (sharing an edge)
    std::int64_t euler = 0;       ///< V - E + F over vertices in use
    std::int64_t nonmanifold_edges =
        0;  ///< edges with more than two faces, or two faces running the same way
    std::int64_t nonmanifold_vertices = 0;  ///< vertices whose faces form more than one fan
    std::int64_t flipped_faces = 0;         ///< signed_area2 <= 0
    double area = 0;                        ///< sum of signed areas [px^2]
    double mean_valence = 0;
    double mean_edge_ratio = 0;    ///< mean over faces of longest edge / shortest edge (1 is best)
    double mean_radius_ratio = 0;  ///< mean of 2 inradius / circumradius (1 is best)
    double mean_shape = 0;         ///< mean of q = 4 sqrt(3) area / sum of squared edges (1 is best)
    double min_shape = 0;
    double min_angle_deg = 0;
};
MeshQuality mesh_quality(const BaseMesh& mesh);

/// The pixel map as a mapping of the pixel grid into the plane.
struct MapQuality {
    std::int64_t pixels = 0;           ///< inside the mask
    std::int64_t unmapped = 0;         ///< pixels of `inside` with face kNone or out of range
    std::int64_t outside_simplex = 0;  ///< a weight below 0, or not finite
    std::int64_t flipped_triangles =
        0;                         ///< of the four triangles of each 2x2 cell (both diagonals), area <= 0
    double min_area2 = 0;          ///< least twice-area of those triangles [px^2]; 1 in the source
    double max_jump = 0;           ///< largest distance between the images of two 4-neighbours [px]
    double mean_displacement = 0;  ///< mean distance between a pixel and its image [px]
    double max_displacement = 0;
};
MapQuality map_quality(const BaseMesh& mesh, const PixelMap& map);

/// Where each pixel lands: positions of map.coords in `mesh`, width * height; not finite outside the mask.
std::vector<Vec2d> mapped_positions(const BaseMesh& mesh, const PixelMap& map);

/// Root mean square over pixels of the Euclidean distance in feature space; pixels with map face kNone are
/// left out.
double map_rms(const BaseMesh& mesh, const PixelMap& map, const FeatureImage& reference);

/// Pictures against each other, both as encoded in their colour space, over R, G, B (or Y) of [0, 1].
/// Throws Error(kUsage) where sizes differ.
struct ImageDifference {
    double rms_rgb = 0;  ///< over all samples, 0..1
    double psnr = 0;     ///< 20 log10(1 / rms_rgb) [dB]; infinite when equal
    double rms_luv = 0;  ///< root mean square Euclidean distance in L*u*v* per pixel
    double max_rgb = 0;
};
ImageDifference compare_images(const Image& a, const Image& b);

}  // namespace imgmesh
