// A pixel map from displacements and back: positions on a grid decide faces and weights, exactly.
#pragma once

#include <cstddef>
#include <optional>

#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/displacements.h"
#include "libcore/mesh/pixel_map.h"

namespace imgmesh {

/// A pixel map, or why there is none.
struct LocatedMap {
    PixelMap map;                     ///< without pixels if one is lost
    std::optional<std::size_t> lost;  ///< the first pixel inside that lies on no face
};

/// Returns the face and the weights of every pixel inside, by the rule of docs/format.md, "Positions on a
/// grid". The rule goes by positions alone: other numbers of vertices and faces or other first corners change
/// the map only by these numbers. Where faces lie over one another, any of those that hold the pixel
/// strictly inside may be its face, always the same in this implementation.
///
/// Throws Error(kUnsupported) for a mesh with a vertex off the kPositionStep grid, and for a mesh so twisted
/// that finding its pixels takes long. The caller has checked that face corners are < vertex_count(). The
/// result is the same for any number of threads. Time grows with pixels + faces.
LocatedMap locate_map(const BaseMesh& mesh, const Displacements& displacements, WeightPrecision precision);

/// Returns the displacements on the coarsest grid of 8, 16 or 32 steps from which locate_map() makes exactly
/// this map, with its precision. Nothing if there are none: positions off the grid (a map tracked, warped or
/// made by other software), a displacement of more than 16 bits, or a mesh that locate_map() refuses. Faces
/// must exist. Takes little time where there are none, as the first pixels tell.
///
/// made_of  the displacements from which locate_map() has made this map, if they are known: rows in which
/// they
///          are found again need no check
std::optional<Displacements> displacements_of(const BaseMesh& mesh, const PixelMap& map,
                                              const Displacements* made_of = nullptr);

}  // namespace imgmesh
