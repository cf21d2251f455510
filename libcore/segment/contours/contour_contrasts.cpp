#include "libcore/segment/contours/contour_contrasts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "libcore/base/parallel.h"
#include "libcore/segment/contours/half_discs.h"

namespace imgmesh {
namespace {

constexpr int kGrain = 64;           // cracks a block
constexpr int kDirectionRadius = 4;  // pairs within this many (small) pixels tell an outline's direction

// Pairs of neighbours in different regions that lie on one crack of the small image.
struct Place {
    Crack crack;  // of the small image
    Crack pair;   // the first of the image's own pairs there
};

// The direction across the outline [radians]: signed steps over the border of the same two regions, summed.
double normal_at(const LabelImage& regions, const Crack& pair, int radius) {
    const int right = pair.down ? 0 : 1, down = pair.down ? 1 : 0;
    const Id a = regions.at(pair.x, pair.y), b = regions.at(pair.x + right, pair.y + down);
    // Twice the coordinates: cracks lie halfway between pixels.
    const int centre_x = 2 * pair.x + right, centre_y = 2 * pair.y + down, reach = 4 * radius * radius;
    int across_x = 0, across_y = 0;
    for (int y = std::max(0, pair.y - radius); y <= std::min(regions.height - 1, pair.y + radius + 1); ++y)
        for (int x = std::max(0, pair.x - radius); x <= std::min(regions.width - 1, pair.x + radius + 1);
             ++x) {
            const Id here = regions.at(x, y);
            if (here != a && here != b) continue;
            const Id other = here == a ? b : a;
            const int sign = here == a ? 1 : -1, dx = 2 * x - centre_x, dy = 2 * y - centre_y;
            if (x + 1 < regions.width && regions.at(x + 1, y) == other &&
                (dx + 1) * (dx + 1) + dy * dy <= reach)
                across_x += sign;
            if (y + 1 < regions.height && regions.at(x, y + 1) == other &&
                dx * dx + (dy + 1) * (dy + 1) <= reach)
                across_y += sign;
        }
    // Where the steps cancel, as around a single pixel, the pair's own direction remains.
    if (across_x == 0 && across_y == 0) return std::atan2(double(down), double(right));
    return std::atan2(double(across_y), double(across_x));
}

// The small image's crack nearest to that of a pair; it has at least two columns for pairs to the right, and
// two rows for pairs below.
Crack small_crack(const Crack& pair, const SmallImage& small) {
    const int f = small.factor;
    const auto edge = [&](int first, int size) {
        return std::clamp((first + 1 + f / 2) / f - 1, 0, size - 2);
    };
    if (pair.down) return {pair.x / f, edge(pair.y, small.inside.height), true};
    return {edge(pair.x, small.inside.width), pair.y / f, false};
}

}  // namespace

PairContrasts contour_contrasts(const FeatureImage& image, const LabelImage& regions) {
    // An image of few rows or columns would have none left to compare.
    const int thin = std::min(image.width, image.height);
    const SmallImage small =
        small_image(image, regions, std::min(measuring_factor(image), std::max(1, thin / 2)));
    const HalfDiscs discs(small);

    PairContrasts contrasts{std::vector<float>(regions.size(), 0.0f),
                            std::vector<float>(regions.size(), 0.0f)};
    std::array<Grid<Id>, 2> place_of = {Grid<Id>(small.inside, kNone), Grid<Id>(small.inside, kNone)};
    std::vector<Place> places;
    const auto visit = [&](const auto& act) {
        for (int y = 0; y < regions.height; ++y)
            for (int x = 0; x < regions.width; ++x)
                for (const bool down : {false, true}) {
                    const int x2 = down ? x : x + 1, y2 = down ? y + 1 : y;
                    if (!regions.contains(x2, y2)) continue;
                    const Id a = regions.at(x, y), b = regions.at(x2, y2);
                    if (a == b || a == kNone || b == kNone) continue;
                    const Crack pair{x, y, down}, crack = small_crack(pair, small);
                    act(pair, crack, place_of[down ? 1 : 0].at(crack.x, crack.y));
                }
    };
    visit([&](const Crack& pair, const Crack& crack, Id& place) {
        if (place != kNone) return;
        place = as_id(places.size());
        places.push_back({crack, pair});
    });
    std::vector<float> measured(places.size());
    parallel_blocks(0, as_int(places.size()), kGrain, [&](int begin, int end) {
        for (std::size_t i = as_index(begin); i < as_index(end); ++i)
            measured[i] = discs.contrast(places[i].crack,
                                         normal_at(regions, places[i].pair, kDirectionRadius * small.factor));
    });
    visit([&](const Crack& pair, const Crack&, Id& place) {
        (pair.down ? contrasts.down : contrasts.right)[regions.index(pair.x, pair.y)] = measured[place];
    });
    return contrasts;
}

}  // namespace imgmesh
