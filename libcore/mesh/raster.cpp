// A scanline rasteriser. A corner's weight times the face's area is linear in the sample's position, and so
// is the place where it is zero. Each row of a face is therefore one span, bounded by three such functions.
// The ends of a span are estimated by a multiplication and then settled by the functions' exact signs.
#include "libcore/mesh/raster.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "libcore/base/parallel.h"
#include "libcore/base/parallel_vector.h"

namespace imgmesh {
namespace {

// Rows of one block: the work spreads well over threads, and few faces lie in two blocks.
constexpr int kBandRows = 32;

// value(x, y) = c + dx x + dy y is twice the area of the triangle of the sample and the side (p, q). That is
// the weight of the opposite corner times twice the face's area.
struct SideFunction {
    SideFunction(const Vec2f& p, const Vec2f& q)
        : dx(double(q.y()) - p.y()),
          dy(double(p.x()) - q.x()),
          c(double(p.y()) * q.x() - double(p.x()) * q.y()),
          guess(dx != 0 ? -1 / dx : 0) {}
    double dx, dy, c, guess;
};

// Estimates the index of the sample nearest to x, in [0, size].
int index_near(double x, double scale, int size) {
    return static_cast<int>(std::clamp((x + 0.5) * scale, 0.0, double(size)));
}

// Returns the first index at which `inside` holds. `inside` is monotone over [0, size): false, then true.
template <typename Inside>
int first_index(int guess, int size, Inside inside) {
    while (guess < size && !inside(guess)) ++guess;
    while (guess > 0 && inside(guess - 1)) --guess;
    return guess;
}

// Returns weights as whole multiples of the step: each is rounded, then the sum is kept at 1 or below.
PixelCoord coordinate(Id face, double u, double v) {
    constexpr int kOne = static_cast<int>(1 / kFloatWeightStep);
    const int iu = std::min(static_cast<int>(u * kOne + 0.5), kOne);
    const int iv = std::min(static_cast<int>(v * kOne + 0.5), kOne - iu);
    return {face, static_cast<float>(iu) * kFloatWeightStep, static_cast<float>(iv) * kFloatWeightStep};
}

// Writes the rows [first, last) of one face. All sums are exact multiples of kPositionStep * kSampleStep.
void rasterize_face(const BaseMesh& mesh, Id id, const SampleGrid& grid, int first, int last, PixelMap& out) {
    const Vec2f &a = mesh.position[mesh.faces[id][0]], &b = mesh.position[mesh.faces[id][1]],
                &c = mesh.position[mesh.faces[id][2]];
    const SideFunction side[3] = {{b, c}, {c, a}, {a, b}};
    const double inverse_area = 1 / signed_area2(a, b, c);
    const int width = out.width;
    const double* xs = grid.x.data();
    for (int j = first; j < last; ++j) {
        const double y = grid.y[as_index(j)];
        int begin = 0, end = width;
        double at_zero[3];
        for (int s = 0; s < 3; ++s) {
            const double r = at_zero[s] = side[s].c + side[s].dy * y, dx = side[s].dx;
            if (dx == 0) {
                if (r < 0) end = 0;
                continue;
            }
            const int guess = index_near(r * side[s].guess, grid.scale, width);
            if (dx > 0)
                begin =
                    std::max(begin, first_index(guess, width, [&](int i) { return r + dx * xs[i] >= 0; }));
            else
                end = std::min(end, first_index(guess, width, [&](int i) { return r + dx * xs[i] < 0; }));
        }
        PixelCoord* row = out.row(j).data();
        for (int i = begin; i < end; ++i)
            row[i] = coordinate(id, (at_zero[1] + side[1].dx * xs[i]) * inverse_area,
                                (at_zero[2] + side[2].dx * xs[i]) * inverse_area);
    }
}

// A face and the rows of the grid that it can touch.
struct FaceRows {
    Id face;
    int first, last;
};

std::vector<std::vector<FaceRows>> sort_into_bands(const BaseMesh& mesh, const SampleGrid& grid, int height) {
    std::vector<std::vector<FaceRows>> bands(as_index((height + kBandRows - 1) / kBandRows));
    // Highest id first: where faces share an edge, the lowest one is written last and stays.
    for (std::size_t f = mesh.faces.size(); f-- > 0;) {
        const auto [ia, ib, ic] = mesh.faces[f];
        const Vec2f &a = mesh.position[ia], &b = mesh.position[ib], &c = mesh.position[ic];
        if (!(signed_area2(a, b, c) > 0)) continue;
        const double top = std::min({a.y(), b.y(), c.y()}), bottom = std::max({a.y(), b.y(), c.y()});
        const auto row_of = [&](double y, auto reached) {
            return first_index(index_near(y, grid.scale, height), height,
                               [&](int j) { return reached(grid.y[as_index(j)], y); });
        };
        const int first = row_of(top, std::greater_equal<double>()),
                  last = row_of(bottom, std::greater<double>());
        for (int band = first / kBandRows; band * kBandRows < last; ++band)
            bands[as_index(band)].push_back(
                {as_id(f), std::max(first, band * kBandRows), std::min(last, (band + 1) * kBandRows)});
    }
    return bands;
}

std::vector<double> sample_positions(int side, double scale) {
    const double low = side > 1 ? 0 : -0.5, high = side > 1 ? side - 1 : 0.5;
    std::vector<double> positions(as_index(std::max(1L, std::lround(scale * side))));
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const double x = std::clamp((double(i) + 0.5) / scale - 0.5, low, high);
        positions[i] = std::round(x / kSampleStep) * kSampleStep;
    }
    return positions;
}

}  // namespace

SampleGrid sample_grid(int width, int height, double scale) {
    return {sample_positions(width, scale), sample_positions(height, scale), scale};
}

PixelMap rasterize(const BaseMesh& mesh, const SampleGrid& grid) {
    PixelMap map(as_int(grid.x.size()), as_int(grid.y.size()),
                 parallel_vector<PixelCoord>(grid.x.size() * grid.y.size()));
    const auto bands = sort_into_bands(mesh, grid, map.height);
    parallel_blocks(0, as_int(bands.size()), 1, [&](int band, int) {
        for (const FaceRows& rows : bands[as_index(band)])
            rasterize_face(mesh, rows.face, grid, rows.first, rows.last, map);
    });
    return map;
}

}  // namespace imgmesh
