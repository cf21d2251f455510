#include "libcore/segment/merge_regions.h"

#include <algorithm>
#include <numeric>
#include <queue>
#include <span>
#include <utility>

#include "libcore/base/index.h"

namespace imgmesh {
namespace {

struct Candidate {
    bool waits;  // until the merges forced by min_size are done
    float distance;
    float pixels;  // of both regions
    Id a, b;       // as in Border
    Id border;
    std::uint32_t version;
    Id list;  // where the candidates that follow this one are

    // The queue's top is the greatest candidate.
    bool operator<(const Candidate& other) const {
        if (waits != other.waits) return waits;
        if (distance != other.distance) return distance > other.distance;
        if (pixels != other.pixels) return pixels > other.pixels;
        return a != other.a ? a > other.a : b > other.b;
    }
};

class Merger {
  public:
    Merger(RegionGraph graph, const RegionDistance& distance, std::int64_t min_size)
        : graph_(std::move(graph)),
          distance_(distance),
          min_size_(double(min_size)),
          version_(graph_.borders.size(), 0),
          borders_of_(graph_.regions.size()),
          list_of_(graph_.regions.size()),
          lists_(graph_.regions.size()),
          found_(graph_.regions.size(), kNone) {
        std::iota(list_of_.begin(), list_of_.end(), Id{0});
        std::vector<Id> own;  // borders with regions of higher numbers
        for (Id e = 0; e < graph_.borders.size(); ++e) {
            const Border& border = graph_.borders[e];
            borders_of_[border.a].push_back(e);
            borders_of_[border.b].push_back(e);
            own.push_back(e);
            if (e + 1 < graph_.borders.size() && graph_.borders[e + 1].a == border.a) continue;
            file(border.a, own);
            own.clear();
        }
    }

    Hierarchy run(std::size_t least) {
        Hierarchy hierarchy{graph_.regions.size(), {}, 0};
        float height = 0;
        while (!queue_.empty()) {
            const Candidate next = queue_.top();
            queue_.pop();
            if (next.version != version_[next.border]) {
                queue_next(next.list);
                continue;
            }
            // Regions only grow: once no merge is forced, none will be.
            if (next.waits && hierarchy.cells - hierarchy.merges.size() <= least) break;
            if (next.waits)
                height = std::max(height, next.distance);
            else
                ++hierarchy.forced;
            hierarchy.merges.push_back({next.a, next.b, height});
            merge(next.a, next.b, next.border);
        }
        return hierarchy;
    }

    // The regions that the merges have left. Ends the merger.
    RegionGraph rest(const Hierarchy& merged) {
        const std::vector<Id> number = regions_after(merged, merged.merges.size());
        RegionGraph graph;
        graph.regions.resize(merged.cells - merged.merges.size());
        // A region's sums are where its first cell was.
        for (std::size_t i = number.size(); i-- > 0;) graph.regions[number[i]] = graph_.regions[i];
        for (std::size_t e = 0; e < graph_.borders.size(); ++e) {
            if (version_[e] == kDead) continue;
            Border& border = graph.borders.emplace_back(graph_.borders[e]);
            border.a = number[border.a];
            border.b = number[border.b];
        }
        std::ranges::sort(graph.borders, {}, [](const Border& b) { return std::pair(b.a, b.b); });
        return graph;
    }

  private:
    static constexpr std::uint32_t kDead = 0xFFFFFFFFu;

    // Candidates of one region without the closest, which is in the queue. The queue would otherwise hold a
    // candidate of every border anew after every merge, nearly all of which are stale before they come up.
    struct List {
        std::vector<Candidate> candidates;
        bool is_heap = false;
    };

    Candidate candidate(Id e, Id list) const {
        const Border& border = graph_.borders[e];
        const RegionSums &a = graph_.regions[border.a], &b = graph_.regions[border.b];
        const auto distance = static_cast<float>(distance_(a, b, border));
        return {.waits = std::min(a.pixels, b.pixels) >= min_size_,
                .distance = distance,
                .pixels = static_cast<float>(a.pixels + b.pixels),
                .a = border.a,
                .b = border.b,
                .border = e,
                .version = version_[e],
                .list = list};
    }

    // Puts the closest candidate of a list into the queue. A list has no order until it is needed: most
    // are made anew before.
    void queue_next(Id list) {
        std::vector<Candidate>& rest = lists_[list].candidates;
        if (!lists_[list].is_heap) std::make_heap(rest.begin(), rest.end());
        lists_[list].is_heap = true;
        while (!rest.empty()) {
            std::pop_heap(rest.begin(), rest.end());
            const Candidate next = rest.back();
            rest.pop_back();
            if (next.version != version_[next.border]) continue;
            queue_.push(next);
            return;
        }
    }

    // Makes a region's list anew, of candidates with `borders`.
    void file(Id region, std::span<const Id> borders) {
        std::vector<Candidate> all = std::exchange(lists_[list_of_[region]].candidates, {});
        list_of_[region] = as_id(lists_.size());
        lists_.emplace_back();
        if (borders.empty()) return;
        all.clear();
        for (const Id e : borders) all.push_back(candidate(e, list_of_[region]));
        const auto closest = std::max_element(all.begin(), all.end());
        queue_.push(*closest);
        *closest = all.back();
        all.pop_back();
        lists_.back().candidates = std::move(all);
    }

    // Region b becomes part of a; a < b.
    void merge(Id a, Id b, Id common) {
        graph_.regions[a] += graph_.regions[b];
        version_[common] = kDead;
        std::vector<Id>& kept = borders_of_[a];
        std::erase_if(kept, [&](Id e) { return version_[e] == kDead; });
        for (const Id e : kept) found_[other_end(e, a)] = e;
        for (const Id e : borders_of_[b]) {
            if (version_[e] == kDead) continue;
            Border& border = graph_.borders[e];
            const Id far = other_end(e, b);
            if (found_[far] != kNone) {
                graph_.borders[found_[far]].length += border.length;
                graph_.borders[found_[far]].contrast += border.contrast;
                version_[e] = kDead;
                continue;
            }
            border.a = std::min(a, far);
            border.b = std::max(a, far);
            kept.push_back(e);
        }
        borders_of_[b] = {};
        lists_[list_of_[b]] = {};
        for (const Id e : kept) {
            found_[other_end(e, a)] = kNone;
            ++version_[e];
        }
        file(a, kept);
    }

    Id other_end(Id e, Id end) const {
        const Border& border = graph_.borders[e];
        return border.a == end ? border.b : border.a;
    }

    RegionGraph graph_;
    const RegionDistance& distance_;
    double min_size_;
    std::vector<std::uint32_t> version_;  // of each border; candidates with an older version are stale
    std::vector<std::vector<Id>> borders_of_;
    std::vector<Id> list_of_;  // of each region; older lists of it are empty
    std::vector<List> lists_;
    std::vector<Id> found_;  // during a merge: the border that leads to each region
    std::priority_queue<Candidate> queue_;
};

}  // namespace

Hierarchy merge_regions(RegionGraph graph, const RegionDistance& distance, std::int64_t min_size,
                        std::size_t least) {
    return Merger(std::move(graph), distance, min_size).run(least);
}

MergedRegions merge_to(RegionGraph graph, const RegionDistance& distance, std::size_t least) {
    Merger merger(std::move(graph), distance, 1);
    MergedRegions merged{merger.run(least), {}};
    merged.graph = merger.rest(merged.hierarchy);
    return merged;
}

}  // namespace imgmesh
