// Edits of a warp: which vertices of which level move where. solve_edits.h turns them into moves.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "libcore/base/types.h"

namespace imgmesh {

/// Some vertices of one level. Every member that is given adds vertices. Points are in pixels (image.h).
/// "Nearest" means nearest in the unedited mesh; of equal ones the lowest number counts.
struct VertexSelection {
    std::vector<Id> vertices;                     ///< by number in the container
    std::optional<Vec2d> near;                    ///< the vertex nearest to this point
    std::optional<std::array<double, 3>> circle;  ///< all inside a circle: centre x, y and radius
    std::optional<std::array<double, 3>> beyond;  ///< all outside a circle
    std::optional<std::array<double, 4>> box;     ///< all inside a box: left, top, right, bottom
    bool border = false;                          ///< all on the mesh's boundaries
    std::string where;  ///< its name in messages, e.g. "edits.json: /edits/0/pins/1"
};

/// Moves a set of vertices together: first scaled about `center`, then turned about it, then moved.
struct WarpHandle {
    VertexSelection vertices;
    Vec2d move{0, 0};             ///< [pixels], x right, y down
    double rotate_deg = 0;        ///< counter-clockwise as seen on screen
    Vec2d scale{1, 1};            ///< along x and y; > 0
    std::optional<Vec2d> center;  ///< none: the mean of the set's vertices [pixels]
};

enum class WarpSolver {
    kDirect,    ///< only the vertices of the handles move
    kArap,      ///< all vertices except the pins move, so that the mesh stays as rigid as possible
    kInjective  ///< as kArap, but no face turns over; handles may stay short of their places for it
};

/// One edit of one level. Handles that share a vertex add up.
struct WarpEdit {
    int level = 0;
    WarpSolver solver = WarpSolver::kDirect;
    std::vector<WarpHandle> handles;
    /// Vertices that stay; none of them may be in a handle, except that a border is pinned where it is in
    /// none.
    std::vector<VertexSelection> pins;
    std::string where;  ///< its name in messages, e.g. "edits.json: /edits/0"
};

/// All edits count from the unedited image and add up, whatever their levels and their order. Injective ones
/// of one level are one edit with all their handles and pins: the sum of two could fold. A vertex that is a
/// handle in one of them and a pin in another moves.
using WarpEdits = std::vector<WarpEdit>;

}  // namespace imgmesh
