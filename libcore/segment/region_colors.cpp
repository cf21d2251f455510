#include "libcore/segment/region_colors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_set>

#include "libcore/image/color.h"

namespace imgmesh {
namespace {

// Of this many unused colours the one that is farthest from the neighbours' is taken. The least distance of
// neighbours in the tests' map of 2,000 regions is 41, 49 and 64 for 8, 16 and 32 candidates.
constexpr int kCandidates = 32;
constexpr int kMostTries = 1000;  // where nearly all colours are used

// The k-th colour: hue, saturation and value fill their ranges evenly however many are taken (the sequence of
// M. Roberts, "The unreasonable effectiveness of quasirandom sequences", in three dimensions). Light and
// strong colours alone, so that none is near the black of outside or too pale to tell its hue.
RgbCode color_number(std::uint64_t k) {
    constexpr double kRatio = 1.2207440846057596;  // the root of x^4 = x + 1
    const auto part = [&](int power) {
        const double x = 0.5 + double(k % (1 << 24)) / std::pow(kRatio, power);
        return x - std::floor(x);
    };
    const double hue = 6 * part(1), saturation = 0.45 + 0.5 * part(2), value = 0.5 + 0.5 * part(3);
    RgbCode code;
    for (std::size_t c = 0; c < 3; ++c) {
        constexpr double kTurn[] = {5, 3, 1};  // HSV to RGB in one formula
        const double at = std::fmod(kTurn[c] + hue, 6.0);
        const double share = value * (1 - saturation * std::clamp(std::min(at, 4 - at), 0.0, 1.0));
        code[c] = static_cast<std::uint8_t>(std::lround(255 * share));
    }
    return code;
}

Vec3f luv_of(const RgbCode& code) {
    const Vec3f rgb = Vec3f(code[0], code[1], code[2]) / 255;
    return luv_from_linear(linear_from_encoded(ColorSpace::kSrgb, rgb));
}

}  // namespace

std::vector<RgbCode> distinct_colors(const std::vector<RegionFacts>& facts) {
    // Regions with many neighbours come first: a later one then sees few colours that it must avoid.
    std::vector<std::size_t> order(facts.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return facts[a].neighbors.size() > facts[b].neighbors.size();
    });
    std::vector<RgbCode> colors(facts.size());
    std::vector<Vec3f> luv(facts.size());
    std::vector<bool> done(facts.size(), false);
    std::unordered_set<std::uint32_t> used;
    const auto number_of = [](const RgbCode& c) { return std::uint32_t(c[0]) << 16 | c[1] << 8 | c[2]; };
    std::uint64_t next = 0;
    for (const std::size_t region : order) {
        float best = -1;
        int found = 0;
        for (int tries = 0; found < kCandidates && (tries < kMostTries || found == 0); ++tries) {
            const RgbCode code = color_number(next++);
            if (used.contains(number_of(code)) && tries < kMostTries) continue;
            ++found;
            const Vec3f own = luv_of(code);
            float nearest = std::numeric_limits<float>::max();
            for (const auto& [other, length] : facts[region].neighbors)
                if (done[other]) nearest = std::min(nearest, (luv[other] - own).norm());
            if (nearest <= best) continue;
            best = nearest;
            colors[region] = code;
            luv[region] = own;
        }
        done[region] = true;
        used.insert(number_of(colors[region]));
    }
    return colors;
}

Image draw_colors(const LabelImage& labels, const std::vector<RgbCode>& colors) {
    const bool mask = std::find(labels.begin(), labels.end(), kNone) != labels.end();
    Image image = make_image(labels.width, labels.height, mask ? 4 : 3);
    for (std::size_t i = 0; i < labels.size(); ++i) {
        if (labels[i] == kNone) continue;
        float* const pixel = image.pixel(i);
        for (std::size_t c = 0; c < 3; ++c) pixel[c] = float(colors[labels[i]][c]) / 255;
        if (mask) pixel[3] = 1;
    }
    return image;
}

}  // namespace imgmesh
