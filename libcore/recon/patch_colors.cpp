#include "libcore/recon/patch_colors.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "libcore/base/grid_neighbors.h"

namespace imgmesh {
namespace {

constexpr int kHues = 8;
// Every second hue is also darker, so that neighbouring hues differ for colour-blind people.
constexpr float kLightness[2] = {70, 50};
constexpr float kChroma = 70;        // of the tint [L*u*v* units]: strong, and within sRGB for mid lightness
constexpr float kMeanShare = 0.45f;  // of the patch's mean colour in the result; the rest is tint

// Returns all pairs of faces whose patches touch, in both orders, sorted.
std::vector<std::pair<Id, Id>> touching_patches(const PixelMap& map) {
    std::vector<std::pair<Id, Id>> pairs;
    const auto touch = [&](Id a, Id b) {
        if (a == b || a == kNone || b == kNone) return;
        pairs.emplace_back(a, b);
        pairs.emplace_back(b, a);
    };
    for_neighbor_pixels(map, [&](std::size_t i, std::size_t j) { touch(map[i].face, map[j].face); });
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
}

// Greedy colouring in order of ids. A face gets one of the hues that the fewest of its coloured neighbours
// have: the first after a pseudo-random start, so that all hues are used about equally.
std::vector<int> hues(std::size_t faces, const std::vector<std::pair<Id, Id>>& touching) {
    std::vector<int> hue(faces, -1);
    auto pair = touching.begin();
    for (Id f = 0; f < faces; ++f) {
        int taken[kHues] = {};
        for (; pair != touching.end() && pair->first == f; ++pair)
            if (hue[pair->second] >= 0) ++taken[hue[pair->second]];
        const int start = as_int((f * 2654435761u) >> 29);  // Knuth's multiplicative hash, 3 bits
        int best = start;
        for (int k = 1; k < kHues; ++k)
            if (taken[(start + k) % kHues] < taken[best]) best = (start + k) % kHues;
        hue[f] = best;
    }
    return hue;
}

}  // namespace

std::vector<Vec3f> patch_colors(const BaseMesh& mesh, const PixelMap& map) {
    std::vector<Vec3d> sum(mesh.faces.size(), Vec3d::Zero());
    std::vector<int> pixels(mesh.faces.size());
    for (const PixelCoord& c : map) {
        if (c.face == kNone) continue;
        sum[c.face] += Vec3d(1 - double(c.u) - double(c.v), c.u, c.v);  // weights first, colours below
        ++pixels[c.face];
    }
    const std::vector<int> hue = hues(mesh.faces.size(), touching_patches(map));
    std::vector<Vec3f> colors(mesh.faces.size(), Vec3f::Zero());
    for (std::size_t f = 0; f < colors.size(); ++f) {
        if (pixels[f] == 0) continue;
        const auto [a, b, c] = mesh.faces[f];
        const Vec3f weight = (sum[f] / pixels[f]).cast<float>();
        const auto feature = [&](Id v) { return Eigen::Map<const Vec3f>(mesh.feature_of(v)); };
        const Vec3f mean = weight[0] * feature(a) + weight[1] * feature(b) + weight[2] * feature(c);
        const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(hue[f]) / kHues;
        const Vec3f tint(kLightness[hue[f] % 2], kChroma * std::cos(angle), kChroma * std::sin(angle));
        colors[f] = kMeanShare * mean + (1 - kMeanShare) * tint;
    }
    return colors;
}

}  // namespace imgmesh
