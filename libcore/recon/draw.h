// Images of a level: its reconstruction, and drawings that show the mesh.
#pragma once

#include <string>

#include "libcore/image/image.h"
#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

enum class DrawMode {
    kMap,      ///< every pixel interpolates its face's corners through the pixel map: the reconstruction
    kGouraud,  ///< the base mesh with colours interpolated linearly in L*u*v* over each face
    kWire,     ///< the edges of the base mesh over the (lightened) Gouraud drawing
    kPatches,  ///< each patch (the pixels of one face) in a colour of its own, neighbours distinct
    kFlat,     ///< each face in one colour: the mean of its corners'
    kVisits    ///< how often the collapse touched each pixel: the less the brighter (visit_lightness.h)
};

struct DrawParams {
    DrawMode mode = DrawMode::kMap;
    double scale = 1;  ///< of the output against the image; other than 1 only for gouraud, wire and flat
};

/// Draws level `level_index`. The result has the source's sample type and colour space (linear where light
/// above 1 counts, Gamut::kHdr), clamped to [0, 1] unless the space is linear; RGB, and A where the source
/// has a mask (0 outside the mask for map, patches and visits, outside the mesh for the others). Size is
/// round(scale * source size), at least 1; the centre of output pixel i is at (i + 0.5) / scale - 0.5 of the
/// source. Throws Error(kBadArgument) for a level that is not there or a scale that the mode does not have,
/// Error(kUnsupported) for a mesh without colour or, drawing visits, a file without them. Visits are those
/// down to level 0: no other level has any.
Image draw(const MeshImage& mesh_image, int level_index, const DrawParams& params);

/// The scale, after draw()'s checks of it.
double checked_scale(const SourceInfo& source, const DrawParams& params);

/// The wire drawing (the edges alone, on nothing) or the flat drawing as an SVG document in sRGB. One unit is
/// a source pixel; the image's sides lie half a pixel outside the outermost pixel centres, as in draw().
/// Throws as draw() does, Error(kBadArgument) for another mode.
std::string draw_svg(const MeshImage& mesh_image, int level_index, DrawMode mode);

/// As draw_svg, each face with a linear gradient: of all that SVG can say the nearest to colours interpolated
/// between the corners, exact where the three colours lie on a line. Throws as draw_svg does.
std::string draw_svg_gradient(const MeshImage& mesh_image, int level_index);

}  // namespace imgmesh
