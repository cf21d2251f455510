// The relaxed pixel map: every pixel moves a little to where the base mesh has its colour. The pixel grid
// stays without a fold.
#pragma once

#include <vector>

#include "libcore/image/image.h"
#include "libcore/image/mask.h"
#include "libcore/mesh/adjacency.h"
#include "libcore/mesh/face_field.h"
#include "libcore/mesh/pixel_map.h"

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
        {};  ///< of a masked image's pixels, Freedom bits; empty without a mask

    bool outside(std::size_t pixel) const { return face[pixel] == kNone; }
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

/// The least twice-area that a pixel triangle keeps during moves [px^2]; at rest it is 1.
inline constexpr float kLeastMovingArea = 0.05f;

/// Takes `sweeps` of Gauss-Newton steps on the sum of |c(P) - c|^2 + mu |P - t|^2. c(P) is the base mesh's
/// colour at P, c the pixel's, and t the pixel displaced like the mean of its four neighbours. A step is at
/// most half a pixel. It is halved until all four triangles (both diagonals) of each 2x2 cell around the
/// pixel keep kLeastMovingArea, so the map stays a bijection. Pixels of the image's sides slide along them,
/// corners rest. In a masked image `pixels.freedom` decides that, triangles with a pixel outside do not
/// count, and a pixel that would leave the mesh waits.
///
/// feature    the image, size of `pixels`; both sides at least 2
/// auxiliary  auxiliary_fields() if it has more than three features
/// smoothness mu [feature^2 / px^2], > 0
/// Pixels of one parity of (x, y) move at once and do not depend on each other, so the result is the same for
/// any number of threads.
void relax(PixelEmbedding& pixels, const std::vector<FaceField>& fields, const std::vector<Face>& neighbors,
           const FeatureImage& feature, float smoothness, int sweeps, const AuxiliaryFields& auxiliary = {});

}  // namespace imgmesh
