#include "libcore/image/luv_encoder.h"

#include <algorithm>
#include <cmath>

#include "libcore/base/simd.h"
#include "libcore/image/cie.h"

namespace imgmesh {
namespace {

// The table is indexed by the square root of the linear value. Over it all curves are nearly straight, also
// near black, where pure powers rise steeply. The largest error is about 0.6/65535, in the first step of
// Gamma2.2.
constexpr int kCurveSteps = 4096;

constexpr int kBlock = 64;  // colours in flight: their planes fit the first-level cache
constexpr int kLanes = 8;

// CIE 1976 L*u*v* in single precision.
constexpr float kLinearLightness = float(kLinearSlope * kLinearLimit);
static_assert(kLinearLightness == 8);
constexpr float kLightnessPerY = float(kLinearSlope), kU = float(kWhiteU), kV = float(kWhiteV);

IMGMESH_INLINE Float8 most(Float8 a, float b) {
    const Float8 other = Float8{} + b;
    return a > other ? a : other;
}
IMGMESH_INLINE Float8 least(Float8 a, float b) {
    const Float8 other = Float8{} + b;
    return a < other ? a : other;
}

// With U = 13 L u', V = 13 L v' the inverse of L*u*v* needs one division: X = 9 U k, Z = (156 L - 3 U - 20 V)
// k, k = Y / 4 V. The two branches of Y are added: the cube is constant below L* = 8, the line above.
IMGMESH_INLINE void xyz_from_luv(Float8 l, Float8 u, Float8 v, Float8 (&xyz)[3]) {
    constexpr float kTiny = 1e-30f;  // replaces L <= 0, where chroma is dropped
    const Float8 lightness = most(l, kTiny), chroma = least(most(l * (1 / kTiny), 0), 1);
    const Float8 su = 13 * kU * lightness + chroma * u;
    // v' >= 0.001, as in linear_from_luv().
    const Float8 sv_free = 13 * kV * lightness + chroma * v, sv_least = 0.013f * lightness;
    const Float8 sv = sv_free > sv_least ? sv_free : sv_least;
    const Float8 root = (most(l, kLinearLightness) + 16.0f) * (1.0f / 116);
    xyz[1] = root * root * root + (least(l, kLinearLightness) - kLinearLightness) * (1 / kLightnessPerY);
    const Float8 k = 0.25f * xyz[1] / sv;
    xyz[0] = 9.0f * su * k;
    xyz[2] = (156.0f * lightness - 3.0f * su - 20.0f * sv) * k;
}

}  // namespace

// kBlock colours: R, G and B of each, or where they are in the curve's table: behind which entry, and how far
// to the next.
struct LuvEncoder::Block {
    float rgb[3][kBlock];
    std::int32_t entry[3][kBlock];

    // The planes have a multiple of eight colours.
    IMGMESH_INLINE void convert(const LuvEncoder& e, const float* l, const float* u, const float* v,
                                int count) {
        for (int i = 0; i < count; i += kLanes) {
            Float8 xyz[3];
            xyz_from_luv(load8(l + i), load8(u + i), load8(v + i), xyz);
            for (int c = 0; c < 3; ++c) {
                Float8 out = e.row_[c][0] * xyz[0] + e.row_[c][1] * xyz[1] + e.row_[c][2] * xyz[2];
                if (!e.curve_.empty()) out = least(most(out, 0), 1);
                std::memcpy(rgb[c] + i, &out, sizeof out);
            }
        }
        if (e.curve_.empty()) return;
        for (int c = 0; c < 3; ++c)
            for (int i = 0; i < count; ++i) {
                const float place = std::sqrt(rgb[c][i]) * float(kCurveSteps);
                entry[c][i] = static_cast<std::int32_t>(place);
                rgb[c][i] = place - static_cast<float>(entry[c][i]);
            }
    }
#if defined(__x86_64__)
    __attribute__((target("avx2"))) void convert_avx2(const LuvEncoder& e, const float* l, const float* u,
                                                      const float* v, int count) {
        convert(e, l, u, v, count);
    }
#endif
};

Vec3f encoded_from_luv(ColorSpace space, const Vec3f& luv) {
    const Vec3f encoded = encoded_from_linear(space, linear_from_luv(luv));
    return space == ColorSpace::kLinear ? encoded : Vec3f(encoded.cwiseMax(0.0f).cwiseMin(1.0f));
}

LuvEncoder::LuvEncoder(ColorSpace space) {
    const Eigen::Matrix3f matrix = rgb_from_xyz(space).cast<float>();
    for (int c = 0; c < 3; ++c)
        for (int k = 0; k < 3; ++k) row_[c][k] = matrix(c, k);
    if (space == ColorSpace::kLinear) return;
    curve_.reserve(kCurveSteps + 1);  // the last entry rises by nothing
    for (int i = 0; i <= kCurveSteps; ++i) {
        const double root = double(i) / kCurveSteps;
        curve_.push_back({encoded_grey(space, static_cast<float>(root * root)), 0});
        if (i > 0) curve_[as_index(i - 1)].rise = curve_.back().value - curve_[as_index(i - 1)].value;
    }
}

void LuvEncoder::encode_row(std::span<const float> luv, int count, float* out, int stride) const {
    Block block;
    float rest[3][kBlock];
    for (int first = 0; first < count; first += kBlock, out += kBlock * stride) {
        const int n = std::min(kBlock, count - first);
        const float* plane[3] = {luv.data() + first, luv.data() + count + first,
                                 luv.data() + 2 * count + first};
        if (n < kBlock)  // the planes end before eight colours do
            for (int c = 0; c < 3; ++c) {
                std::fill(std::copy_n(plane[c], n, rest[c]), rest[c] + kBlock, 0.0f);
                plane[c] = rest[c];
            }
#if defined(__x86_64__)
        static const bool kAvx2 = has_avx2();
        if (kAvx2)
            block.convert_avx2(*this, plane[0], plane[1], plane[2], kBlock);
        else
#endif
            block.convert(*this, plane[0], plane[1], plane[2], kBlock);
        float* to = out;
        for (int i = 0; i < n; ++i, to += stride)
            for (int c = 0; c < 3; ++c) {
                to[c] = block.rgb[c][i];
                if (curve_.empty()) continue;
                const auto& [value, rise] = curve_[static_cast<std::size_t>(block.entry[c][i])];
                to[c] = value + to[c] * rise;
            }
    }
}

}  // namespace imgmesh
