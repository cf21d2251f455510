#include "libcore/segment/seeds.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "libcore/base/disjoint_sets.h"
#include "libcore/base/error.h"
#include "libcore/base/grid_neighbors.h"

namespace imgmesh {
namespace {

enum Kind : std::uint8_t { kUnknown = 0, kKeep = 1, kDrop = 2, kBoth = 3 };

// Calls visit(pixel) for the pixels of a seed: its points, and between two of them one in each column or row.
template <typename Visit>
void for_seed_pixels(const Seed& seed, const GridSize& size, const Visit& visit) {
    for (const Seed::Point& p : seed.points)
        if (p.x < 0 || p.y < 0 || p.x >= size.width || p.y >= size.height)
            throw Error(ErrorKind::kBadArgument, cat(seed.where, ": pixel ", p.x, ",", p.y,
                                                     " is outside the image, whose pixels are 0,0 to ",
                                                     size.width - 1, ",", size.height - 1));
    for (std::size_t i = 0; i < seed.points.size(); ++i) {
        const Seed::Point a = seed.points[i], b = seed.points[std::min(i + 1, seed.points.size() - 1)];
        const std::int64_t steps = std::max(std::abs(b.x - a.x), std::abs(b.y - a.y));
        for (std::int64_t k = 0; k <= steps; ++k) {
            const double t = steps == 0 ? 0 : double(k) / double(steps);
            visit(size.index(as_int(a.x + std::llround(t * double(b.x - a.x))),
                             as_int(a.y + std::llround(t * double(b.y - a.y)))));
        }
    }
}

// The kind of each part that a seed lies in. Parts are cells or regions; kNone is outside the mask.
std::vector<Kind> kinds_of(const Grid<Id>& parts, std::size_t count, std::span<const Seed> seeds) {
    std::vector<Kind> kind(count, kUnknown);
    std::vector<const Seed*> holder(count, nullptr);
    for (const Seed& seed : seeds) {
        bool inside = false;
        for_seed_pixels(seed, parts, [&](std::size_t pixel) {
            const Id part = parts[pixel];
            if (part == kNone) return;
            inside = true;
            const Kind own = seed.keep ? kKeep : kDrop;
            if (kind[part] != kUnknown && kind[part] != own)
                throw Error(
                    ErrorKind::kUnsupported,
                    cat(holder[part]->where, " and ", seed.where,
                        " lie in one patch, the smallest part that there is; expected seeds farther apart, "
                        "or a mesh with more faces"));
            kind[part] = own;
            holder[part] = &seed;
        });
        if (!inside) throw Error(ErrorKind::kBadArgument, cat(seed.where, ": is outside the mask"));
    }
    return kind;
}

// For each cell its neighbours, once for every pair of pixels across the border.
struct CellNeighbors {
    std::vector<std::size_t> begin;
    std::vector<Id> neighbor;

    explicit CellNeighbors(const Cells& cells) : begin(cells.count() + 1, 0) {
        const auto for_pairs = [&](const auto& visit) {
            for_neighbor_pixels(cells, [&](std::size_t i, std::size_t j) {
                const Id a = cells[i], b = cells[j];
                if (a == b || a == kNone || b == kNone) return;
                visit(a, b);
                visit(b, a);
            });
        };
        for_pairs([&](Id a, Id) { ++begin[a + 1]; });
        for (std::size_t c = 0; c < cells.count(); ++c) begin[c + 1] += begin[c];
        neighbor.resize(begin.back());
        std::vector<std::size_t> at(begin.begin(), begin.end() - 1);
        for_pairs([&](Id a, Id b) { neighbor[at[a]++] = b; });
    }
    std::span<const Id> of(Id cell) const {
        return {neighbor.data() + begin[cell], begin[cell + 1] - begin[cell]};
    }
};

// Gives every cell a kind, merge by merge. A region either has no kind yet, then its cells are in a list, or
// all of its cells have one.
class Spread {
  public:
    Spread(const Cells& cells, std::vector<Kind> kinds)
        : neighbors_(cells),
          kind_(std::move(kinds)),
          regions_(cells.count()),
          found_(kind_),
          next_(cells.count(), kNone),
          last_(cells.count()) {
        for (Id c = 0; c < last_.size(); ++c) last_[c] = c;
    }

    void merge(Id cell_a, Id cell_b) {
        const Id a = regions_.find(cell_a), b = regions_.find(cell_b);
        if (found_[a] == kUnknown && found_[b] != kUnknown) give(a, b);
        if (found_[b] == kUnknown && found_[a] != kUnknown) give(b, a);
        const auto both = static_cast<Kind>(found_[a] | found_[b]);
        regions_.join(a, b);
        const Id all = std::min(a, b), other = std::max(a, b);  // the first cell stands for the region
        found_[all] = both;
        next_[last_[all]] = other;
        last_[all] = last_[other];
    }

    Kind kind(Id cell) const { return kind_[cell]; }

  private:
    // The cells of region `a` get a kind from region `b`.
    void give(Id a, Id b) {
        Kind kind = found_[b];
        if (kind == kBoth) {
            std::array<std::size_t, 4> length = {};
            for (Id c = a; c != kNone; c = next_[c])
                for (const Id n : neighbors_.of(c))
                    if (regions_.find(n) == b) ++length[kind_[n]];
            kind = length[kKeep] > length[kDrop] ? kKeep : kDrop;
        }
        for (Id c = a; c != kNone; c = next_[c]) kind_[c] = kind;
    }

    CellNeighbors neighbors_;
    std::vector<Kind> kind_;
    DisjointSets regions_;
    std::vector<Kind> found_;      // at the first cell of each region: which kinds it holds
    std::vector<Id> next_, last_;  // the list of a region's cells
};

}  // namespace

Mask choose_by_seeds(const Segmentation& result, std::span<const Seed> seeds) {
    if (seeds.empty()) throw Error(ErrorKind::kBadArgument, "no seed was given, expected at least one");
    const bool keeps = std::ranges::any_of(seeds, &Seed::keep);
    const bool drops = !std::ranges::all_of(seeds, &Seed::keep);
    const Cells& cells = result.cells;
    Mask mask(cells);
    if (keeps && drops) {
        Spread spread(cells, kinds_of(cells, cells.count(), seeds));
        for (const Merge& merge : result.hierarchy.merges) spread.merge(merge.a, merge.b);
        for (std::size_t i = 0; i < mask.size(); ++i)
            mask[i] = cells[i] != kNone && spread.kind(cells[i]) == kKeep;
    } else {
        const std::vector<Kind> kind = kinds_of(result.labels, result.labels.count, seeds);
        for (std::size_t i = 0; i < mask.size(); ++i) {
            const Id region = result.labels[i];
            mask[i] = region != kNone && (kind[region] == kUnknown) != keeps;
        }
    }
    if (mask.count() == 0)
        throw Error(ErrorKind::kUnsupported,
                    "every region holds a seed of what is dropped, so no pixel is kept");
    return mask;
}

Image mask_image(const Mask& mask) {
    Image image = make_image(mask.width, mask.height, 1);
    std::ranges::transform(mask, image.data.begin(),
                           [](std::uint8_t inside) { return inside != 0 ? 1.0f : 0.0f; });
    return image;
}

}  // namespace imgmesh
