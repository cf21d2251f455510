// Pixel maps for tests of segmentation, which depends on the pixels that share a face and not on the mesh.
#pragma once

#include <random>
#include <utility>
#include <vector>

#include "libcore/mesh/mesh_image.h"

namespace imgmesh::test {

/// All weights are a third, except for pixels outside.
inline PixelMap map_of_faces(int width, int height, const std::vector<Id>& faces) {
    PixelMap map{width, height, {}, WeightPrecision::kFloat};
    for (const Id face : faces)
        map.values.push_back(face == kNone ? PixelCoord{} : PixelCoord{face, 1.0f / 3, 1.0f / 3});
    return map;
}

inline Level level_of(PixelMap map) {
    Level level;
    level.map = std::move(map);
    return level;
}

/// A level and the image that it is of.
struct Sample {
    Level level;
    FeatureImage picture;
};

/// Patches are blobs around random seeds, some torn, with colours of a few kinds and noise. With a mask about
/// a fifth of the pixels are outside.
inline Sample sample(int width, int height, int patches, bool mask, std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    std::vector<Vec2f> centers;
    std::vector<Vec3f> colors;
    for (int i = 0; i < patches; ++i) {
        centers.emplace_back(float(below(width)), float(below(height)));
        colors.emplace_back(float(20 * below(5)), float(10 * below(3)), float(10 * below(3)));
    }
    std::vector<Id> faces;
    FeatureImage picture{width, height, 3, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Vec2f at(static_cast<float>(x), static_cast<float>(y));
            std::size_t best = 0;
            for (std::size_t i = 0; i < centers.size(); ++i)
                if ((centers[i] - at).squaredNorm() < (centers[best] - at).squaredNorm()) best = i;
            // Sometimes two blobs share a face: a patch in several parts.
            faces.push_back(mask && below(5) == 0 ? kNone
                                                  : static_cast<Id>(best / 2 * 2 % 7 == 0 ? best / 2 : best));
            for (int c = 0; c < 3; ++c) picture.data.push_back(colors[best][c] + float(below(1000)) / 250);
        }
    PixelMap map = map_of_faces(width, height, faces);
    for (PixelCoord& coord : map) {
        if (coord.face == kNone) continue;
        coord.u = float(below(512)) / 1024;
        coord.v = float(below(512)) / 1024;
    }
    return {level_of(std::move(map)), std::move(picture)};
}

}  // namespace imgmesh::test
