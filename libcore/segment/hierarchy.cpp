#include "libcore/segment/hierarchy.h"

#include <algorithm>
#include <numeric>

#include "libcore/base/error.h"
#include "libcore/base/index.h"

namespace imgmesh {

std::size_t merges_below(const Hierarchy& hierarchy, double threshold) {
    const auto end = std::partition_point(hierarchy.merges.begin(), hierarchy.merges.end(),
                                          [&](const Merge& m) { return double(m.height) < threshold; });
    return as_index(end - hierarchy.merges.begin());
}

std::size_t merges_to_count(const Hierarchy& hierarchy, std::int64_t count, std::string_view source,
                            std::string& missed) {
    const std::size_t wanted = as_index(count), least = hierarchy.cells - hierarchy.merges.size(),
                      most = hierarchy.cells - hierarchy.forced;
    if (wanted > most)
        missed = cat(count, " regions were wanted, at most ", most,
                     hierarchy.forced > 0 ? " of that size can be had from " : " can be had from ", source);
    if (wanted < least)
        missed = cat(count, count == 1 ? " region was wanted, " : " regions were wanted, ", least,
                     " are the fewest: so many islands has the mask");
    return hierarchy.cells - std::clamp(wanted, least, most);
}

std::size_t clearest_merges(const Hierarchy& hierarchy, double low, double high) {
    const std::vector<Merge>& merges = hierarchy.merges;
    const std::size_t first = merges_below(hierarchy, low), end = merges_below(hierarchy, high);
    std::size_t best = first;
    double widest = 0;
    for (std::size_t k = first; k <= end; ++k) {
        const double from = k == first ? low : double(merges[k - 1].height);
        const double to = k == end ? high : double(merges[k].height);
        if (to / from <= widest) continue;
        widest = to / from;
        best = k;
    }
    return best;
}

std::vector<Id> regions_after(const Hierarchy& hierarchy, std::size_t merges) {
    // The a and b of every merge are the first cells of their regions, and a < b.
    std::vector<Id> region(hierarchy.cells);
    std::iota(region.begin(), region.end(), Id{0});
    for (std::size_t k = 0; k < merges; ++k) region[hierarchy.merges[k].b] = hierarchy.merges[k].a;
    Id count = 0;
    for (Id cell = 0; cell < region.size(); ++cell)
        region[cell] = region[cell] == cell ? count++ : region[region[cell]];
    return region;
}

}  // namespace imgmesh
