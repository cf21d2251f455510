// The colours that a container holds.
#include <algorithm>
#include <cmath>
#include <limits>

#include "libcore/image/color.h"

namespace imgmesh {
namespace {

constexpr float kLargestCode = 65535;  // of 16 bits

// Less than half a 16-bit code outside counts as inside, so that a result is never projected again.
constexpr float kOutside = 4e-6f;
static_assert(kOutside < 0.5f / kLargestCode);

// Lightness of the greys that colours move towards, less that of the colour: at a slightly different
// lightness the gamut may reach much closer.
constexpr float kShifts[] = {-8, -4, -2, 0, 2, 4, 8};
// Halvings of the way to a grey: the gamut's rim is found to 1/4096 of it.
constexpr int kHalvings = 12;

}  // namespace

Vec3f in_gamut(const Vec3f& luv, Gamut gamut) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const float most = gamut == Gamut::kDisplay ? 1.0f : kInfinity,
                lightest = gamut == Gamut::kDisplay ? 100.0f : kInfinity;
    const auto inside = [most](const Vec3f& color) {
        const Vec3f linear = linear_from_luv(color);
        const float slack = kOutside * (most > 1 ? std::max(1.0f, linear.maxCoeff()) : 1.0f);
        // Without lightness there is no chroma: linear_from_luv() turns any (0, u, v) into black.
        return linear.minCoeff() >= -slack && linear.maxCoeff() <= most + slack &&
               (color[0] > 0 || (color[1] == 0 && color[2] == 0));
    };
    if (inside(luv)) return luv;
    // The way to a grey of the same lightness always enters the gamut; bisection finds where.
    const Vec3f grey(std::clamp(luv[0], 0.0f, lightest), 0, 0);
    Vec3f best = luv_from_linear(linear_from_luv(luv).cwiseMax(0.0f).cwiseMin(most));
    for (const float shift : kShifts) {
        const Vec3f center(std::clamp(grey[0] + shift, 0.0f, lightest), 0, 0);
        const Vec3f rim(center[0], luv[1], luv[2]);
        float low = 0, high = 1;
        for (int step = 0; step < kHalvings; ++step) {
            const float middle = 0.5f * (low + high);
            (inside(center + middle * (rim - center)) ? low : high) = middle;
        }
        const Vec3f candidate = center + low * (rim - center);
        if ((candidate - luv).squaredNorm() < (best - luv).squaredNorm()) best = candidate;
    }
    return best;
}

std::array<std::uint16_t, 3> color_codes(const Vec3f& luv) {
    const Vec3f linear = linear_from_luv(in_gamut(luv));
    const auto code = [&](int c) {
        return static_cast<std::uint16_t>(std::lround(std::clamp(linear[c], 0.0f, 1.0f) * kLargestCode));
    };
    return {code(0), code(1), code(2)};
}

Vec3f color_from_codes(const std::array<std::uint16_t, 3>& codes) {
    return luv_from_linear(Vec3f(codes[0], codes[1], codes[2]) / kLargestCode);
}

Vec3f quantized_hdr(const Vec3f& luv) {
    constexpr int kBits = 16, kLeastExponent = -4;
    Vec3f linear = linear_from_luv(in_gamut(luv, Gamut::kHdr)).cwiseMax(0.0f).cwiseMin(kMaxHdr);
    // Round once more, because rounding may reach the next power of two, whose step is twice as large.
    for (int pass = 0; pass < 2; ++pass) {
        int exponent = 0;
        std::frexp(linear.maxCoeff(), &exponent);
        const float step = std::ldexp(1.0f, std::max(exponent, kLeastExponent) - kBits);
        for (float& x : linear) x = std::round(x / step) * step;
    }
    return linear;
}

Vec3f quantized_color(const Vec3f& luv, Gamut gamut) {
    return gamut == Gamut::kDisplay ? color_from_codes(color_codes(luv))
                                    : luv_from_linear(quantized_hdr(luv));
}

}  // namespace imgmesh
