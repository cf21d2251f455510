// The relaxed pixel map: every pixel moves a little to where the base mesh has its colour, while the pixel
// grid stays a grid without a fold.
#pragma once

#include <vector>

#include "libcore/image/image.h"
#include "libcore/param/face_field.h"
#include "libcore/param/pixel_map.h"

namespace imgmesh {

/// Where each pixel of a W x H picture lies on the base mesh, while it is being moved.
struct MovingPixels {
    int width = 0;
    int height = 0;
    std::vector<float> dx, dy;  ///< image of the pixel less the pixel [pixels]
    std::vector<Id> face;       ///< the face that the image lies in

    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
    Vec2f image_of(int x, int y) const {
        const std::size_t i = index(x, y);
        return {static_cast<float>(x) + dx[i], static_cast<float>(y) + dy[i]};
    }
};

/// Every pixel at its own place, in its face of `trivial`.
MovingPixels resting_pixels(const PixelMap& trivial);

/// The least twice-area of a pixel triangle that moving keeps [px^2]; at rest it is 1.
inline constexpr float kLeastMovingArea = 0.05f;

/// `sweeps` of Gauss-Newton steps on sum |c(P) - c|^2 + mu |P - t|^2, c(P) the base mesh's colour at P, c the
/// pixel's, t the pixel displaced like the mean of its four neighbours. Steps are at most half a pixel and
/// are halved until all four triangles (both diagonals) of each 2x2 cell around the pixel keep
/// kLeastMovingArea, so the map stays a bijection. Pixels of the picture's sides slide along them, corners
/// rest.
///
/// feature    the picture, size of `pixels`; both sides at least 2
/// further    further_fields() where it has more than three features
/// smoothness mu [feature^2 / px^2], > 0
/// Pixels of one parity of (x, y) move at once and do not see each other: same result for any number of
/// threads.
void relax(MovingPixels& pixels, const std::vector<FaceField>& fields, const std::vector<Face>& neighbors,
           const FeatureImage& feature, float smoothness, int sweeps, const FurtherFields& further = {});

}  // namespace imgmesh
