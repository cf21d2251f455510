// Pictures of a level: its reconstruction, and drawings that show the mesh.
#pragma once

#include <string>

#include "libcore/image/image.h"
#include "libcore/param/mesh_image.h"

namespace imgmesh {

enum class DrawMode {
    kMap,      ///< every pixel interpolates its face's corners through the pixel map: the reconstruction
    kGouraud,  ///< the base mesh with colours interpolated linearly in L*u*v* over each face
    kWire,     ///< the edges of the base mesh over the (lightened) Gouraud drawing
    kPatches,  ///< each patch (the pixels of one face) in a colour of its own, neighbours distinct
    kFlat      ///< each face in one colour: the mean of its corners'
};

struct DrawParams {
    DrawMode mode = DrawMode::kMap;
    double scale = 1;  ///< of the output against the picture; other than 1 only for gouraud, wire and flat
};

/// Draws level `level_index`. The result has the source's colour space, clamped to [0, 1] unless the source
/// is linear; RGB, and A where the source has a mask (0 outside). Size is round(scale * source size), at
/// least 1. Throws Error(kUsage) for a level that is not there or a scale that the mode does not have.
Image draw(const MeshImage& mesh_image, int level_index, const DrawParams& params);

/// The wire or flat drawing as an SVG document, resolution-independent.
std::string draw_svg(const MeshImage& mesh_image, int level_index, DrawMode mode);

}  // namespace imgmesh
