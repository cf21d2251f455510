#include "libcore/segment/contours/contour_contrasts.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "libcore/base/parallel.h"

namespace imgmesh {
namespace {

constexpr int kGrain = 64;           // cracks a block
constexpr int kDirectionRadius = 4;  // pairs within this many (small) pixels tell an outline's direction

// The direction across the outline [radians]: signed steps over the border of the same two regions, summed.
double normal_at(const Grid<Id>& regions, const Crack& pair, int radius) {
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

// Calls act(pair) for the pairs of neighbours in different regions that begin in `own`, row by row.
template <typename Act>
void visit_pairs(const Grid<Id>& regions, const PixelRect& own, const Act& act) {
    for (int y = own.top; y < own.bottom; ++y)
        for (int x = own.left; x < own.right; ++x)
            for (const bool down : {false, true}) {
                const int x2 = down ? x : x + 1, y2 = down ? y + 1 : y;
                if (!regions.contains(x2, y2)) continue;
                const Id a = regions.at(x, y), b = regions.at(x2, y2);
                if (a == b || a == kNone || b == kNone) continue;
                act(Crack{x, y, down});
            }
}

bool comes_first(const Crack& p, const Crack& q) {
    return std::tuple(p.y, p.x, p.down) < std::tuple(q.y, q.x, q.down);
}

}  // namespace

ContourPlaces::ContourPlaces(const GridSize& image, int factor)
    : image_(image),
      factor_(factor),
      small_{(image.width + factor - 1) / factor, (image.height + factor - 1) / factor},
      place_of_{Grid<Id>(small_, kNone), Grid<Id>(small_, kNone)} {}

int ContourPlaces::margin() const {
    return kDirectionRadius * factor_ + 1;
}

// It has at least two columns for pairs to the right, and two rows for pairs below.
Crack ContourPlaces::small_crack(const Crack& pair) const {
    const auto edge = [&](int first, int size) {
        return std::clamp((first + 1 + factor_ / 2) / factor_ - 1, 0, size - 2);
    };
    if (pair.down) return {pair.x / factor_, edge(pair.y, small_.height), true};
    return {edge(pair.x, small_.width), pair.y / factor_, false};
}

void ContourPlaces::add(const Grid<Id>& window, int left, int top, const PixelRect& own) {
    std::vector<Id> changed;
    visit_pairs(window, own, [&](const Crack& at) {
        const Crack pair{left + at.x, top + at.y, at.down}, crack = small_crack(pair);
        Id& place = place_of_[crack.down ? 1 : 0].at(crack.x, crack.y);
        if (place == kNone) {
            place = as_id(places_.size());
            places_.push_back({crack, pair});
        } else if (comes_first(pair, places_[place].pair)) {
            places_[place].pair = pair;
        } else {
            return;
        }
        changed.push_back(place);
    });
    std::ranges::sort(changed);
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
    parallel_blocks(0, as_int(changed.size()), kGrain, [&](int begin, int end) {
        for (std::size_t i = as_index(begin); i < as_index(end); ++i) {
            Place& place = places_[changed[i]];
            const Crack at{place.pair.x - left, place.pair.y - top, place.pair.down};
            place.normal = normal_at(window, at, kDirectionRadius * factor_);
        }
    });
}

void ContourPlaces::measure(const SmallImage& small) {
    const HalfDiscs discs(small);
    measured_.resize(places_.size());
    parallel_blocks(0, as_int(places_.size()), kGrain, [&](int begin, int end) {
        for (std::size_t i = as_index(begin); i < as_index(end); ++i)
            measured_[i] = discs.contrast(places_[i].crack, places_[i].normal);
    });
}

PairContrasts ContourPlaces::contrasts(const Grid<Id>& window, int left, int top,
                                       const PixelRect& own) const {
    PairContrasts contrasts{std::vector<float>(window.size(), 0.0f), std::vector<float>(window.size(), 0.0f)};
    visit_pairs(window, own, [&](const Crack& at) {
        const Crack crack = small_crack({left + at.x, top + at.y, at.down});
        (at.down ? contrasts.down : contrasts.right)[window.index(at.x, at.y)] =
            measured_[place_of_[crack.down ? 1 : 0].at(crack.x, crack.y)];
    });
    return contrasts;
}

PairContrasts contour_contrasts(const FeatureImage& image, const LabelImage& regions) {
    const int factor = disc_factor(image);
    ContourPlaces places(image, factor);
    const PixelRect all{0, 0, image.width, image.height};
    places.add(regions, 0, 0, all);
    places.measure(small_image(image, regions, factor));
    return places.contrasts(regions, 0, 0, all);
}

}  // namespace imgmesh
