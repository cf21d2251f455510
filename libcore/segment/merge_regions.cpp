#include "libcore/segment/merge_regions.h"

#include <algorithm>
#include <queue>

namespace imgmesh {
namespace {

struct Candidate {
    bool waits;  // until the merges forced by min_size are done
    float distance;
    float pixels;  // of both regions
    Id a, b;       // as in Border
    Id border;
    std::uint32_t version;

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
          found_(graph_.regions.size(), kNone) {
        for (Id e = 0; e < graph_.borders.size(); ++e) {
            borders_of_[graph_.borders[e].a].push_back(e);
            borders_of_[graph_.borders[e].b].push_back(e);
            file(e);
        }
    }

    Hierarchy run(std::size_t least) {
        Hierarchy hierarchy{graph_.regions.size(), {}, 0};
        float height = 0;
        while (!queue_.empty()) {
            const Candidate next = queue_.top();
            queue_.pop();
            if (next.version != version_[next.border]) continue;
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

  private:
    static constexpr std::uint32_t kDead = 0xFFFFFFFFu;

    void file(Id e) {
        const Border& border = graph_.borders[e];
        const RegionSums &a = graph_.regions[border.a], &b = graph_.regions[border.b];
        const auto distance = static_cast<float>(distance_(a, b, border));
        queue_.push({std::min(a.pixels, b.pixels) >= min_size_, distance,
                     static_cast<float>(a.pixels + b.pixels), border.a, border.b, e, version_[e]});
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
        for (const Id e : kept) {
            found_[other_end(e, a)] = kNone;
            ++version_[e];
            file(e);
        }
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
    std::vector<Id> found_;  // during a merge: the border that leads to each region
    std::priority_queue<Candidate> queue_;
};

}  // namespace

Hierarchy merge_regions(RegionGraph graph, const RegionDistance& distance, std::int64_t min_size,
                        std::size_t least) {
    return Merger(std::move(graph), distance, min_size).run(least);
}

}  // namespace imgmesh
