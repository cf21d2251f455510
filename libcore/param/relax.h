// The relaxed pixel map: every pixel moves a little to where the base mesh has its colour. The pixel grid
// stays without a fold.
#pragma once

#include <vector>

#include "libcore/image/image.h"
#include "libcore/image/mask.h"
#include "libcore/mesh/adjacency.h"
#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/displacements.h"
#include "libcore/mesh/face_field.h"
#include "libcore/mesh/pixel_map.h"
#include "libcore/mesh/tile_sides.h"

namespace imgmesh {

/// How a pixel of a masked image may move, as bits.
enum Freedom : std::uint8_t {
    kPinnedX = 1,  ///< x stays
    kPinnedY = 2,  ///< y stays
    kFree = 4      ///< inside the boundary, with triangles all around: its straight neighbours are inside too
};

/// The place of each pixel of a W x H image on the base mesh while it is being moved.
struct PixelEmbedding : GridSize {
    std::vector<float> dx, dy;  ///< place on the mesh minus the pixel [pixels]; NaN outside a mask
    std::vector<Id> face;       ///< the face that holds the place; kNone outside a mask
    std::vector<std::uint8_t> freedom =
        {};                   ///< of a masked image's pixels, Freedom bits; empty without a mask
    bool sides_stay = false;  ///< whether pixels on the image's sides do not move

    /// Whether nothing but its neighbours limits the moves of an inner pixel.
    bool is_free(int x, int y) const {
        return freedom.empty() ? !pinned_x(x, y) && !pinned_y(x, y) : freedom[index(x, y)] & kFree;
    }
    bool outside(std::size_t pixel) const { return face[pixel] == kNone; }
    bool stays(int x, int y) const {
        return sides_stay && (x == 0 || y == 0 || x == width - 1 || y == height - 1);
    }
    bool pinned_x(int x, int y) const {
        return freedom.empty() ? x == 0 || x == width - 1 : freedom[index(x, y)] & kPinnedX;
    }
    bool pinned_y(int x, int y) const {
        return freedom.empty() ? y == 0 || y == height - 1 : freedom[index(x, y)] & kPinnedY;
    }

    Vec2f image_of(int x, int y) const {
        const std::size_t i = index(x, y);
        return {static_cast<float>(x) + dx[i], static_cast<float>(y) + dy[i]};
    }
};

/// Puts every pixel inside the mask at its own place, in its face of `trivial`, which has the same mask.
/// Pixels on a straight horizontal or vertical part of the mask's boundary may slide along it. Where it bends
/// or pinches, and in strips one pixel wide, they rest. So the map takes the dense mesh onto itself.
PixelEmbedding resting_pixels(const PixelMap& trivial, const Mask& mask = {});

/// Puts the pixels of a tile's sides where the sides have them, for good. All pixels are at rest before.
void place_sides(PixelEmbedding& pixels, const TileSides& sides, const std::vector<FaceField>& fields,
                 const std::vector<Face>& neighbors);

/// The least twice-area that a pixel triangle keeps during moves, on a grid of `steps` in a pixel [px^2]; at
/// rest it is 1. It is more than what weights of half precision change in faces of usual size; on the
/// coarsest grid two units, as four would cost error.
constexpr float least_moving_area(int steps) {
    return steps > 8 ? 0.05f : 0.03f;
}

struct RelaxParams {
    float smoothness = 20;    ///< mu: of the grid of pixels against colour [feature^2 / px^2]; > 0
    int steps = kUsualSteps;  ///< of the grid of positions in a pixel: 8, 16 or 32
    float rate = 0;           ///< what a bit of a stored displacement costs [feature^2]; 0: nothing
    int sweeps = 4;
    float stride = 1;  ///< length of a step, in Newton's; above 1, below 2: fewer sweeps, a less even map
};

/// Takes Gauss-Newton steps on the sum of |c(P) - c|^2 + mu |P - t|^2. c(P) is the base mesh's colour at P, c
/// the pixel's, and t the pixel displaced like the mean of its four neighbours. A step is at most a pixel
/// either way and ends on the grid of positions, where all arithmetic on them is exact. All four triangles
/// (both diagonals) of each 2x2 cell around the pixel keep least_moving_area(), so the map stays a bijection:
/// a step that would fold one is turned aside from it, and if that does not do, halved. A step is taken only
/// if it lowers the sum, in another face by that face's own colours. Pixels of the image's sides slide along
/// them, corners rest. In a masked image `pixels.freedom` decides that, triangles with a pixel outside do not
/// count, and a pixel that would leave the mesh waits.
///
/// With a rate, a free pixel goes to the cheapest of a few places near the best one. A place also costs the
/// bits that a median predictor leaves of it and of the neighbours that are predicted from it, and it is not
/// asked whether the sum has fallen.
///
/// mesh       as is for `fields`; `pixels` lies on it, on the grid of `params.steps`
/// feature    the image, size of `pixels`; both sides at least 2
/// Pixels of one parity of (x, y) move at once and do not depend on each other, so the result is the same for
/// any number of threads.
void relax(PixelEmbedding& pixels, const BaseMesh& mesh, const std::vector<FaceField>& fields,
           const std::vector<Face>& neighbors, const FeatureImage& feature, const RelaxParams& params);

/// Returns where the pixels are, as whole numbers of the grid on which relax() has put them.
Displacements displacements(const PixelEmbedding& pixels, int steps);

}  // namespace imgmesh
