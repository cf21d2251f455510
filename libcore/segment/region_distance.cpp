#include "libcore/segment/region_distance.h"

#include <algorithm>
#include <cmath>

#include "libcore/base/dot.h"
#include "libcore/segment/pair_contrasts.h"

namespace imgmesh {
namespace {

// Chosen on ten images. On these and on ten others they are within noise of the best values. Each may change
// by a third without harm (docs/decisions/0009-segmentation.md has the figures).
constexpr double kBorderShare = 0.7;    // of the contrast along the border, against the populations
constexpr double kSizeExponent = 0.2;   // small regions are details of their surroundings
constexpr double kShapeExponent = 0.2;  // regions joined along most of their boundary belong together

// Beyond this distance of colours [L*u*v*] superpixels count it, not its square. Without that, specks of
// strong contrast take superpixels that weak edges need (docs/decisions/0010-superpixels.md).
constexpr double kStrongContrast = 5;

// Huber's loss, twice, of a distance's square.
double huber(double square) {
    return square <= kStrongContrast * kStrongContrast
               ? square
               : kStrongContrast * (2 * std::sqrt(square) - kStrongContrast);
}

double harmonic(double a, double b) {
    return a * b / (a + b);
}

// The squared length of a colour.
double square(const Vec3d& color) {
    return dot(color, color);
}

}  // namespace

RegionDistance paper_distance() {
    return [](const RegionSums& a, const RegionSums& b, const Border&) {
        return std::sqrt(square(a.paper_color() - b.paper_color()));
    };
}

RegionDistance contour_distance(double pixels) {
    return [pixels](const RegionSums& a, const RegionSums& b, const Border& border) {
        const double regions =
            1 - std::exp(-population_distance(a.mean_color(), a.variance(), b.mean_color(), b.variance()));
        const double m = kBorderShare * border.mean_contrast() + (1 - kBorderShare) * regions;
        const double size = 4 * harmonic(a.pixels, b.pixels) / pixels;
        const double shape = border.length / std::sqrt(2 * std::min(a.pixels, b.pixels));
        return m * std::pow(size, kSizeExponent) * std::pow(shape, -kShapeExponent);
    };
}

RegionDistance superpixel_distance(double compactness, double spacing) {
    const double scale = compactness / spacing;
    return [scale](const RegionSums& a, const RegionSums& b, const Border&) {
        const double color = huber(square(a.mean_color() - b.mean_color()));
        const double place = (a.mean_place() - b.mean_place()).squaredNorm();
        return harmonic(a.pixels, b.pixels) * (color + scale * scale * place);
    };
}

}  // namespace imgmesh
