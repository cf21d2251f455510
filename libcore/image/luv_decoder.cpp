#include "libcore/image/luv_decoder.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libcore/base/simd.h"
#include "libcore/image/cie.h"

namespace imgmesh {
namespace {

constexpr int kCodes = 256;
constexpr int kLanes = 8;

IMGMESH_INLINE Float8 in_every_lane(float x) {
    return Float8{} + x;
}

// Returns the cube root of each lane, for lanes above 0. A third of the exponent is within 4 % of it; each of
// Halley's steps triples the digits.
IMGMESH_INLINE Float8 cube_root(Float8 y) {
    constexpr std::int32_t kTwoThirdsOfOne = 709921077;  // of the bits of 1.0f, less what makes errors equal
    Int8 bits;
    std::memcpy(&bits, &y, sizeof bits);
    bits =
        __builtin_convertvector(__builtin_convertvector(bits, Float8) * (1.0f / 3), Int8) + kTwoThirdsOfOne;
    Float8 root;
    std::memcpy(&root, &bits, sizeof root);
    for (int step = 0; step < 2; ++step) {
        const Float8 cube = root * root * root;
        root = root * ((cube + 2 * y) / (2 * cube + y));
    }
    return root;
}

}  // namespace

struct LuvDecoder::Lanes {
    // Turns eight linear colours into L*, u* and v*, in place.
    static IMGMESH_INLINE void decode(const LuvDecoder& d, float* r8, float* g8, float* b8) {
        const Float8 low = in_every_lane(d.low_), high = in_every_lane(d.high_);
        const auto clipped = [&](const float* p) {
            const Float8 x = load8(p), above = x > low ? x : low;
            return above < high ? above : high;
        };
        const Float8 r = clipped(r8), g = clipped(g8), b = clipped(b8);
        const Float8 y = d.y_[0] * r + d.y_[1] * g + d.y_[2] * b;
        const Float8 sum = d.sum_[0] * r + d.sum_[1] * g + d.sum_[2] * b;
        constexpr auto kLimit = static_cast<float>(kLinearLimit), kSlope = static_cast<float>(kLinearSlope);
        const auto root = y > kLimit;
        const Float8 l = root ? 116 * cube_root(root ? y : in_every_lane(1)) - 16 : kSlope * y;
        const auto colored = sum > 0;
        const Float8 scale = colored ? 13 * l / (colored ? sum : in_every_lane(1)) : Float8{};
        const Float8 u = scale * (d.u_[0] * (r - g) + d.u_[1] * (b - g));
        const Float8 v = scale * (d.v_[0] * (r - g) + d.v_[1] * (b - g));
        std::memcpy(r8, &l, sizeof l);
        std::memcpy(g8, &u, sizeof u);
        std::memcpy(b8, &v, sizeof v);
    }
    static IMGMESH_INLINE void decode_all(const LuvDecoder& d, float* planes, int size) {
        for (int x = 0; x < size; x += kLanes)
            decode(d, planes + x, planes + size + x, planes + 2 * size + x);
    }
#if defined(__x86_64__)
    __attribute__((target("avx2"))) static void decode_all_avx2(const LuvDecoder& d, float* planes,
                                                                int size) {
        decode_all(d, planes, size);
    }
#endif
};

LuvDecoder::LuvDecoder(ColorSpace space, Range range, bool codes)
    : space_(space),
      low_(range == Range::kAny ? std::numeric_limits<float>::lowest() : 0.0f),
      high_(range == Range::kAny       ? std::numeric_limits<float>::max()
            : range == Range::kClipped ? 1.0f
                                       : kMaxHdr) {
    const Eigen::Matrix3d xyz = xyz_from_linear();
    for (std::size_t c = 0; c < 3; ++c) {
        const auto column = static_cast<Eigen::Index>(c);
        const double x = xyz(0, column), y = xyz(1, column), sum = x + 15 * y + 3 * xyz(2, column);
        y_[c] = static_cast<float>(y);
        sum_[c] = static_cast<float>(sum);
        if (c == 1) continue;
        u_[c / 2] = static_cast<float>(4 * x - kWhiteU * sum);
        v_[c / 2] = static_cast<float>(9 * y - kWhiteV * sum);
    }
    // Other primaries mix the channels.
    if (!codes || space == ColorSpace::kAdobeRgb || space == ColorSpace::kDisplayP3) return;
    for (int k = 0; k < kCodes; ++k) {
        code_.push_back(static_cast<float>(k) / 255.0f);
        value_.push_back(linear_from_encoded(space, Vec3f::Constant(code_.back()))[0]);
    }
}

void LuvDecoder::decode_row(const float* pixels, int stride, const std::array<int, 3>& rgb, int width,
                            std::vector<float>& planes, float* out) const {
    const int size = (width + kLanes - 1) / kLanes * kLanes;
    planes.assign(3 * static_cast<std::size_t>(size), 0.0f);
    float* const plane[3] = {planes.data(), planes.data() + size, planes.data() + 2 * size};
    for (int x = 0; x < width; ++x, pixels += stride) {
        bool coded = !code_.empty();
        for (int c = 0; c < 3 && coded; ++c) {
            const float encoded = pixels[rgb[static_cast<std::size_t>(c)]], code = encoded * 255.0f;
            const auto k = static_cast<std::size_t>(code >= 0 && code <= 255 ? code + 0.5f : 0);
            coded = code_[k] == encoded;
            plane[c][x] = value_[k];
        }
        if (coded) continue;
        const Vec3f linear = linear_from_encoded(space_, {pixels[rgb[0]], pixels[rgb[1]], pixels[rgb[2]]});
        for (int c = 0; c < 3; ++c) plane[c][x] = linear[c];
    }
#if defined(__x86_64__)
    static const bool kAvx2 = has_avx2();
    if (kAvx2)
        Lanes::decode_all_avx2(*this, planes.data(), size);
    else
#endif
        Lanes::decode_all(*this, planes.data(), size);
    for (int x = 0; x < width; ++x)
        for (int c = 0; c < 3; ++c) *out++ = plane[c][x];
}

}  // namespace imgmesh
