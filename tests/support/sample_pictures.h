// Small difficult images, for tests of what must hold for every image.
#pragma once

#include <cmath>
#include <random>
#include <string>

#include "libcore/image/color.h"
#include "libcore/image/image.h"

namespace imgmesh::test {

enum class Kind {
    kConstant,      ///< no gradient anywhere: every edge ties
    kGradient,      ///< smooth
    kCheckerboard,  ///< black and white pixels: every diagonal ties, gradients as steep as can be
    kNoise,         ///< independent colours: no structure at all
    kDisc           ///< two flat colours and one sharp edge
};
inline constexpr Kind kAllKinds[] = {Kind::kConstant, Kind::kGradient, Kind::kCheckerboard, Kind::kNoise,
                                     Kind::kDisc};

inline std::string name_of(Kind kind) {
    constexpr const char* kNames[] = {"constant", "gradient", "checkerboard", "noise", "disc"};
    return kNames[static_cast<int>(kind)];
}

/// An sRGB image of that kind, values in [0, 1]. `seed` matters for noise alone.
inline Image sample_picture(Kind kind, int width, int height, std::uint32_t seed = 1) {
    std::mt19937 random(seed);
    Image image = make_image(width, height, 3);
    const auto color = [&](int x, int y) -> Vec3f {
        const float fx = static_cast<float>(x) / static_cast<float>(width),
                    fy = static_cast<float>(y) / static_cast<float>(height);
        switch (kind) {
            case Kind::kConstant:
                return {0.2f, 0.5f, 0.7f};
            case Kind::kGradient:
                return {0.1f + 0.7f * fx, 0.2f + 0.5f * fy, 0.5f + 0.3f * std::sin(5 * fx * fy)};
            case Kind::kCheckerboard:
                return Vec3f::Constant(static_cast<float>((x + y) % 2));
            case Kind::kNoise: {
                Vec3f noise;
                for (int c = 0; c < 3; ++c) noise[c] = static_cast<float>(random() % 256) / 255.0f;
                return noise;
            }
            case Kind::kDisc:
                break;
        }
        const bool inside = (fx - 0.45f) * (fx - 0.45f) + (fy - 0.55f) * (fy - 0.55f) < 0.09f;
        return inside ? Vec3f(0.9f, 0.3f, 0.1f) : Vec3f(0.1f, 0.3f, 0.4f);
    };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Vec3f c = color(x, y);
            std::copy(c.data(), c.data() + 3, image.pixel(x, y));
        }
    return image;
}

inline FeatureImage sample_feature(Kind kind, int width, int height, std::uint32_t seed = 1) {
    return luv_image(sample_picture(kind, width, height, seed));
}

}  // namespace imgmesh::test
