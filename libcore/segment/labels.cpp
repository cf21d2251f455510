#include "libcore/segment/labels.h"

#include <algorithm>

#include "libcore/base/grid_neighbors.h"

namespace imgmesh {

LabelImage labels_after(const Cells& cells, const Hierarchy& hierarchy, std::size_t merges) {
    // Cells are numbered by their first pixel and regions by their first cell, hence by their first pixel.
    const std::vector<Id> region = regions_after(hierarchy, merges);
    LabelImage labels(cells, hierarchy.cells - merges);
    for (Id& label : labels)
        if (label != kNone) label = region[label];
    return labels;
}

std::vector<RegionFacts> region_facts(const LabelImage& labels, const FeatureImage& image) {
    std::vector<RegionFacts> facts(labels.count);
    std::vector<Vec3d> sums(labels.count, Vec3d::Zero());
    std::vector<std::pair<Id, Id>> pairs;
    for_neighbor_pixels(labels, [&](std::size_t i, std::size_t j) {
        const Id a = labels[i], b = labels[j];
        if (a == b || a == kNone || b == kNone) return;
        pairs.emplace_back(a, b);
        pairs.emplace_back(b, a);
    });
    for (int y = 0; y < labels.height; ++y)
        for (int x = 0; x < labels.width; ++x) {
            const Id region = labels.at(x, y);
            if (region == kNone) continue;
            RegionFacts& f = facts[region];
            if (f.pixels == 0) f.box = {x, y, x, y};
            f.box = {std::min(f.box[0], x), f.box[1], std::max(f.box[2], x), y};
            ++f.pixels;
            sums[region] += Eigen::Map<const Vec3f>(image.pixel(x, y)).cast<double>();
        }
    for (std::size_t r = 0; r < facts.size(); ++r)
        facts[r].color = (sums[r] / double(facts[r].pixels)).cast<float>();
    std::sort(pairs.begin(), pairs.end());
    for (const auto& [a, b] : pairs) {
        auto& neighbors = facts[a].neighbors;
        if (neighbors.empty() || neighbors.back().first != b) neighbors.emplace_back(b, 0);
        ++neighbors.back().second;
    }
    return facts;
}

}  // namespace imgmesh
