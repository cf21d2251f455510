#include "libcore/segment/region_graph.h"

#include <algorithm>

namespace imgmesh {
namespace {

struct Crossing {
    Id a, b;
    float contrast;
};

// Pairs of neighbours in different cells, in the order of their pixels.
std::vector<Crossing> crossings(const Cells& cells, const PairContrasts& contrasts) {
    std::vector<Crossing> all;
    const auto cross = [&](std::size_t i, std::size_t j, const std::vector<float>& contrast) {
        const Id a = cells[i], b = cells[j];
        if (a == b || a == kNone || b == kNone) return;
        all.push_back({std::min(a, b), std::max(a, b), contrast.empty() ? 0.0f : contrast[i]});
    };
    for (int y = 0; y < cells.height; ++y)
        for (int x = 0; x < cells.width; ++x) {
            const std::size_t i = cells.index(x, y);
            if (x + 1 < cells.width) cross(i, cells.index(x + 1, y), contrasts.right);
            if (y + 1 < cells.height) cross(i, cells.index(x, y + 1), contrasts.down);
        }
    return all;
}

}  // namespace

RegionSums& RegionSums::operator+=(const RegionSums& other) {
    pixels += other.pixels;
    color += other.color;
    square += other.square;
    weight += other.weight;
    weighted_color += other.weighted_color;
    place += other.place;
    return *this;
}

Vec3d RegionSums::variance() const {
    const Vec3d mean = mean_color();
    return (square / pixels - mean.cwiseProduct(mean)).cwiseMax(0.0);
}

RegionGraph region_graph(const Cells& cells, const PixelMap& map, const FeatureImage& image,
                         const PairContrasts& contrasts) {
    RegionGraph graph;
    graph.regions.resize(cells.count());
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (cells[i] == kNone) continue;
        RegionSums& sums = graph.regions[cells[i]];
        const PixelCoord& coord = map[i];
        const double least =
            std::min({1 - double(coord.u) - double(coord.v), double(coord.u), double(coord.v)});
        const Vec3d color = Eigen::Map<const Vec3f>(image.pixel(i)).cast<double>();
        const Vec2d place(cells.x_of(i), cells.y_of(i));
        sums.pixels += 1;
        sums.color += color;
        sums.square += color.cwiseProduct(color);
        sums.weight += least;
        sums.weighted_color += least * color;
        sums.place += place;
    }
    std::vector<Crossing> all = crossings(cells, contrasts);
    std::stable_sort(all.begin(), all.end(),
                     [](const Crossing& p, const Crossing& q) { return p.a != q.a ? p.a < q.a : p.b < q.b; });
    for (const Crossing& crossing : all) {
        if (graph.borders.empty() || graph.borders.back().a != crossing.a ||
            graph.borders.back().b != crossing.b)
            graph.borders.push_back({crossing.a, crossing.b, 0, 0});
        graph.borders.back().length += 1;
        graph.borders.back().contrast += double(crossing.contrast);
    }
    return graph;
}

}  // namespace imgmesh
