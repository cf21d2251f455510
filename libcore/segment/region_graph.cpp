#include "libcore/segment/region_graph.h"

#include <algorithm>

namespace imgmesh {
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

void add_crossings(std::vector<Crossing>& crossings, const Grid<Id>& regions, const PairContrasts& contrasts,
                   const PixelRect& own) {
    const auto cross = [&](std::size_t i, std::size_t j, const std::vector<float>& contrast) {
        const Id a = regions[i], b = regions[j];
        if (a == b || a == kNone || b == kNone) return;
        crossings.push_back({std::min(a, b), std::max(a, b), contrast.empty() ? 0.0f : contrast[i]});
    };
    for (int y = own.top; y < own.bottom; ++y)
        for (int x = own.left; x < own.right; ++x) {
            const std::size_t i = regions.index(x, y);
            if (x + 1 < regions.width) cross(i, regions.index(x + 1, y), contrasts.right);
            if (y + 1 < regions.height) cross(i, regions.index(x, y + 1), contrasts.down);
        }
}

std::vector<Border> borders_of(std::vector<Crossing> crossings) {
    std::stable_sort(crossings.begin(), crossings.end(),
                     [](const Crossing& p, const Crossing& q) { return p.a != q.a ? p.a < q.a : p.b < q.b; });
    std::vector<Border> borders;
    for (const Crossing& crossing : crossings) {
        if (borders.empty() || borders.back().a != crossing.a || borders.back().b != crossing.b)
            borders.push_back({crossing.a, crossing.b, 0, 0});
        borders.back().length += 1;
        borders.back().contrast += double(crossing.contrast);
    }
    return borders;
}

std::vector<Border> joined_borders(std::vector<Border> parts) {
    std::stable_sort(parts.begin(), parts.end(),
                     [](const Border& p, const Border& q) { return p.a != q.a ? p.a < q.a : p.b < q.b; });
    std::vector<Border> borders;
    for (const Border& part : parts) {
        if (borders.empty() || borders.back().a != part.a || borders.back().b != part.b) {
            borders.push_back(part);
            continue;
        }
        borders.back().length += part.length;
        borders.back().contrast += part.contrast;
    }
    return borders;
}

std::vector<RegionSums> region_sums(const Grid<Id>& cells, std::size_t count, const PixelMap& map,
                                    const FeatureImage& image) {
    std::vector<RegionSums> all(count);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (cells[i] == kNone) continue;
        RegionSums& sums = all[cells[i]];
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
    return all;
}

RegionGraph region_graph(const Cells& cells, const PixelMap& map, const FeatureImage& image,
                         const PairContrasts& contrasts) {
    std::vector<Crossing> crossings;
    add_crossings(crossings, cells, contrasts, {0, 0, cells.width, cells.height});
    return {region_sums(cells, cells.count(), map, image), borders_of(std::move(crossings))};
}

}  // namespace imgmesh
