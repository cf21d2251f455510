#include "libcore/image/luv_encoder.h"

#include <algorithm>
#include <cmath>

#include "libcore/image/cie.h"

namespace imgmesh {
namespace {

// The table is indexed by the square root of the linear value. Over it all curves are nearly straight, also
// near black, where pure powers rise steeply. The largest error is about 0.6/65535, in the first step of
// Gamma2.2.
constexpr int kCurveSteps = 4096;

constexpr int kBlock = 64;  // colours in flight: a dozen planes of them fit the first-level cache
using Plane = Eigen::Array<float, Eigen::Dynamic, 1, 0, kBlock, 1>;

// CIE 1976 L*u*v* in single precision.
constexpr float kLinearLightness = float(kLinearSlope * kLinearLimit);
static_assert(kLinearLightness == 8);
constexpr float kLightnessPerY = float(kLinearSlope), kU = float(kWhiteU), kV = float(kWhiteV);

// With U = 13 L u', V = 13 L v' the inverse of L*u*v* needs one division: X = 9 U k, Z = (156 L - 3 U - 20 V)
// k, k = Y / 4 V. The two branches of Y are added: the cube is constant below L* = 8, the line above.
void xyz_from_luv(const Plane& l, const Plane& u, const Plane& v, Plane (&xyz)[3]) {
    constexpr float kTiny = 1e-30f;  // replaces L <= 0, where chroma is dropped
    const Plane lightness = l.max(kTiny), chroma = (l * (1 / kTiny)).max(0.0f).min(1.0f);
    const Plane su = 13 * kU * lightness + chroma * u;
    // v' >= 0.001, as in linear_from_luv().
    const Plane sv = (13 * kV * lightness + chroma * v).max(0.013f * lightness);
    xyz[1] = ((l.max(kLinearLightness) + 16.0f) * (1.0f / 116)).cube() +
             (l.min(kLinearLightness) - kLinearLightness) * (1 / kLightnessPerY);
    const Plane k = 0.25f * xyz[1] / sv;
    xyz[0] = 9.0f * su * k;
    xyz[2] = (156.0f * lightness - 3.0f * su - 20.0f * sv) * k;
}

}  // namespace

Vec3f encoded_from_luv(ColorSpace space, const Vec3f& luv) {
    const Vec3f encoded = encoded_from_linear(space, linear_from_luv(luv));
    return space == ColorSpace::kLinear ? encoded : Vec3f(encoded.cwiseMax(0.0f).cwiseMin(1.0f));
}

LuvEncoder::LuvEncoder(ColorSpace space) : rgb_from_xyz_(rgb_from_xyz(space).cast<float>()) {
    if (space == ColorSpace::kLinear) return;
    // White is white in every space, so greys need only the space's curve. There is one more entry, so that
    // the last value has a right neighbour.
    for (int i = 0; i <= kCurveSteps + 1; ++i) {
        const double root = std::min(double(i) / kCurveSteps, 1.0);
        curve_.push_back(encoded_from_linear(space, Vec3f::Constant(static_cast<float>(root * root)))[1]);
    }
}

void LuvEncoder::encode_row(std::span<const float> luv, int count, float* out, int stride) const {
    Plane xyz[3], channel;
    for (int first = 0; first < count; first += kBlock) {
        const int n = std::min(kBlock, count - first);
        const auto plane = [&](int c) { return Eigen::Map<const Plane>(luv.data() + c * count + first, n); };
        xyz_from_luv(plane(0), plane(1), plane(2), xyz);
        for (int c = 0; c < 3; ++c) {
            channel =
                rgb_from_xyz_(c, 0) * xyz[0] + rgb_from_xyz_(c, 1) * xyz[1] + rgb_from_xyz_(c, 2) * xyz[2];
            float* dst = out + first * stride + c;
            if (curve_.empty()) {
                for (int i = 0; i < n; ++i) dst[i * stride] = channel[i];
                continue;
            }
            float place[kBlock] = {};  // in the curve
            Eigen::Map<Plane>(place, n) = channel.max(0.0f).min(1.0f);
            // Eigen's own square root of several floats is the processor's estimate, which each maker has of
            // its own.
            for (float& x : place) x = std::sqrt(x) * float(kCurveSteps);
            for (int i = 0; i < n; ++i) {
                const int step = static_cast<int>(place[i]);
                const float* entry = curve_.data() + step;
                dst[i * stride] = entry[0] + (place[i] - static_cast<float>(step)) * (entry[1] - entry[0]);
            }
        }
    }
}

}  // namespace imgmesh
