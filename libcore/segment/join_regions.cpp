#include "libcore/segment/join_regions.h"

#include <algorithm>

#include "libcore/base/disjoint_sets.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

// How often each number is in the list: (number, times), by number.
template <typename T>
std::vector<std::pair<T, std::size_t>> counted(std::vector<T> list) {
    std::ranges::sort(list);
    std::vector<std::pair<T, std::size_t>> counts;
    for (const T& item : list) {
        if (counts.empty() || counts.back().first != item) counts.emplace_back(item, 0);
        ++counts.back().second;
    }
    return counts;
}

std::size_t count_of(const std::vector<std::pair<Id, std::size_t>>& counts, Id id) {
    return std::ranges::lower_bound(counts, id, {}, &std::pair<Id, std::size_t>::first)->second;
}

}  // namespace

Id RegionJoiner::add(std::span<const TileRegion> regions) {
    const std::size_t first = regions_.size();
    if (first + regions.size() >= kNone)
        throw Error(ErrorKind::kUnsupported, "the tiles have more regions than there are 32-bit numbers");
    regions_.insert(regions_.end(), regions.begin(), regions.end());
    return as_id(first);
}

void RegionJoiner::add_line(std::span<const Id> a, std::span<const Id> b) {
    std::vector<std::pair<Id, Id>> both;
    std::vector<Id> of_a, of_b;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (a[i] == kNone || b[i] == kNone) continue;
        both.emplace_back(a[i], b[i]);
        of_a.push_back(a[i]);
        of_b.push_back(b[i]);
    }
    const auto a_counts = counted(std::move(of_a)), b_counts = counted(std::move(of_b));
    for (const auto& [pair, common] : counted(std::move(both))) {
        const std::size_t most = std::max(count_of(a_counts, pair.first), count_of(b_counts, pair.second));
        const Vec3f difference = regions_[pair.first].color - regions_[pair.second].color;
        if (2 * common > most || double(difference.norm()) <= threshold_) pairs_.push_back(pair);
    }
}

JoinedRegions RegionJoiner::finish() const {
    DisjointSets sets(regions_.size());
    for (const auto& [a, b] : pairs_) sets.join(a, b);

    JoinedRegions joined;
    joined.numbers.assign(regions_.size(), kNone);
    // (first pixel, set) of each region of the whole picture; two have never the same first pixel.
    std::vector<std::pair<std::int64_t, Id>> firsts;
    std::vector<Id>& place = joined.numbers;  // of a set in `firsts`, at its least member
    std::vector<bool> is_across;
    for (Id i = 0; i < regions_.size(); ++i) {
        if (regions_[i].pixels == 0) continue;
        const Id set = sets.find(i);
        if (place[set] == kNone) {
            place[set] = as_id(firsts.size());
            firsts.emplace_back(regions_[i].first, set);
            is_across.push_back(false);
        } else {
            firsts[place[set]].first = std::min(firsts[place[set]].first, regions_[i].first);
            is_across[place[set]] = true;
        }
    }
    joined.across = std::ranges::count(is_across, true);
    std::ranges::sort(firsts);
    for (std::size_t k = 0; k < firsts.size(); ++k) place[firsts[k].second] = as_id(k);

    joined.pixels.assign(firsts.size(), 0);
    // A set's least member comes before its others, so that its own number is still there when they ask.
    for (Id i = 0; i < regions_.size(); ++i) {
        const Id number = place[sets.find(i)];
        if (number != kNone) joined.pixels[number] += regions_[i].pixels;
    }
    for (Id i = 0; i < regions_.size(); ++i) place[i] = place[sets.find(i)];
    return joined;
}

}  // namespace imgmesh
