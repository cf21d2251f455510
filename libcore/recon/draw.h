// Images of a level: its reconstruction, and drawings that show the mesh.
#pragma once

#include <string>

#include "libcore/image/image.h"
#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

enum class DrawMode {
    kMap,      ///< every pixel interpolates its face's corners through the pixel map: the reconstruction
    kGouraud,  ///< the base mesh with colours interpolated linearly in L*u*v* over each face
    kWire,     ///< the edges of the base mesh over the (lightened) Gouraud drawing, antialiased
    kPatches,  ///< each patch (the pixels of one face) in a colour different from its neighbours'
    kFlat,     ///< each face in one colour, the mean of its corners' colours, antialiased
    kVisits    ///< how often the collapse touched each pixel; few visits are bright (paper fig. 2)
};

struct DrawParams {
    DrawMode mode = DrawMode::kMap;
    double scale = 1;  ///< output size / image size; kMap, kPatches and kVisits allow only 1
};

/// Draws level `level_index`, 0 being the finest.
///
/// return  channels R, G, B in the source's sample type and colour space (HDR meshes in linear RGB), clamped
///         to [0, 1] unless the space is linear. A as well if the source has a mask: 0 outside the mask for
///         map, patches and visits, and outside the mesh for Gouraud; for flat and wire the part of the pixel
///         that they cover. If the mesh has a channel A, the modes map, Gouraud and flat draw it, clamped to
///         [0, 1]; the others are opaque inside. A side has round(scale * source side) pixels, at least 1;
///         the centre of output pixel i is at (i + 0.5) / scale - 0.5 of the source.
///
/// The result is the same for any number of threads. Takes O(pixels drawn + faces) time.
/// Throws Error(kBadArgument) for a level that does not exist, for a scale that the mode does not allow and
/// for more than 2^28 pixels; Error(kUnsupported) for a mesh without colour, and for visits if the mesh image
/// has none or the level is not 0.
Image draw(const MeshImage& mesh_image, int level_index, const DrawParams& params);

/// Returns params.scale. Throws Error(kBadArgument) if draw() would refuse it.
double checked_scale(const SourceInfo& source, const DrawParams& params);

/// Returns the wire drawing (only the edges, on nothing) or the flat drawing as an SVG document in sRGB. One
/// unit is a source pixel. The image's sides lie half a pixel outside the outermost pixel centres, as in
/// draw(). Throws as draw() does, and Error(kBadArgument) for another mode.
std::string draw_svg(const MeshImage& mesh_image, int level_index, DrawMode mode);

/// As draw_svg(), but each face has a linear gradient. SVG cannot interpolate three corner colours; this
/// gradient is the nearest to that, and exact if the three colours lie on a line. A channel A is drawn as
/// opacity. Throws as draw_svg() does.
std::string draw_svg_gradient(const MeshImage& mesh_image, int level_index);

}  // namespace imgmesh
