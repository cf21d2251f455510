// What a user asks a warp to do, as values: which vertices of which level go where.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "libcore/base/types.h"

namespace imgmesh {

/// Some vertices of one level; every member that is given adds to them. Points are in pixels (image.h), and
/// "nearest" is nearest in the unedited mesh, of equal ones the lowest number.
struct VertexSelection {
    std::vector<Id> vertices;                     ///< by number, as in the container
    std::optional<Vec2d> near;                    ///< the vertex nearest to this point
    std::optional<std::array<double, 3>> circle;  ///< all within: centre x, y and radius
    std::optional<std::array<double, 3>> beyond;  ///< all outside of a circle
    std::optional<std::array<double, 4>> box;     ///< all within: left, top, right, bottom
    bool border = false;                          ///< all on the mesh's boundaries
    std::string where;  ///< how messages call it, e.g. "edits.json: /edits/0/pins/1"
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
    kDirect,  ///< only the vertices of the handles move
    kArap     ///< all vertices move but the pins, so that the mesh stays as rigid as possible
};

/// One edit of one level. Handles that share a vertex add up.
struct WarpEdit {
    int level = 0;
    WarpSolver solver = WarpSolver::kDirect;
    std::vector<WarpHandle> handles;
    std::vector<VertexSelection> pins;  ///< vertices that stay; none of them may be in a handle
    std::string where;                  ///< how messages call it, e.g. "edits.json: /edits/0"
};

/// All edits count from the unedited image and add up, whatever their levels and their order.
using WarpEdits = std::vector<WarpEdit>;

}  // namespace imgmesh
