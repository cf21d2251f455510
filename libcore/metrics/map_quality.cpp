#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "libcore/base/error.h"
#include "libcore/base/parallel.h"
#include "libcore/base/parallel_vector.h"
#include "libcore/mesh/grid_area.h"
#include "libcore/mesh/mapped_position.h"
#include "libcore/metrics/metrics.h"

namespace imgmesh {
namespace {

constexpr int kGrainRows = 32;

// Returns where the map places a pixel; NaN for one without a face.
Vec2d position_or_nan(const BaseMesh& mesh, const PixelCoord& coord) {
    if (coord.face >= mesh.faces.size()) return Vec2d::Constant(std::numeric_limits<double>::quiet_NaN());
    return mapped_position(mesh.faces, mesh.position, coord);
}

// The mapped positions of some rows of pixels.
struct MappedRows {
    int first;
    Grid<Vec2d> places;

    MappedRows(const BaseMesh& mesh, const PixelMap& map, int begin, int end)
        : first(begin), places(map.width, end - begin, {}) {
        places.values.reserve(places.pixel_count());
        for (int y = begin; y < end; ++y)
            for (const PixelCoord& coord : map.row(y)) places.values.push_back(position_or_nan(mesh, coord));
    }
    const Vec2d& at(int x, int y) const { return places.at(x, y - first); }
};

// Counts the triangles and steps between the pixel rows y and y + 1. Comparisons with a position that is not
// finite are false, so its triangles and steps do not count. q.max_jump is squared here.
void measure_row(const MappedRows& rows, int width, int height, int y, MapQuality& q) {
    const auto at = [&](int x, int row) -> const Vec2d& { return rows.at(x, row); };
    // Counter-clockwise, as the faces of meshes are.
    const auto triangle = [&](const Vec2d& a, const Vec2d& b, const Vec2d& c) {
        const double area = grid_area2(a, c, b);
        q.flipped_triangles += area <= 0;
        if (area < q.min_area2) q.min_area2 = area;
    };
    const auto step = [&](const Vec2d& a, const Vec2d& b) {
        const double jump = (a - b).squaredNorm();
        if (jump > q.max_jump) q.max_jump = jump;
    };
    for (int x = 0; x < width; ++x) {
        const bool right = x + 1 < width, below = y + 1 < height;
        if (right) step(at(x, y), at(x + 1, y));
        if (below) step(at(x, y), at(x, y + 1));
        if (!right || !below) continue;
        const Vec2d &a = at(x, y), &b = at(x, y + 1), &c = at(x + 1, y + 1), &d = at(x + 1, y);
        triangle(a, b, c);
        triangle(b, c, d);
        triangle(c, d, a);
        triangle(d, a, b);
    }
}

// Counts the pixels of row y. q.mean_displacement is a sum here, over `mapped` pixels.
void measure_pixels(const BaseMesh& mesh, const PixelMap& map, const MappedRows& rows, bool has_mask, int y,
                    MapQuality& q, std::int64_t& mapped) {
    for (int x = 0; x < map.width; ++x) {
        const PixelCoord& c = map.at(x, y);
        if (has_mask && c.face == kNone) continue;
        ++q.pixels;
        if (c.face >= mesh.faces.size()) {
            ++q.unmapped;
            continue;
        }
        // Infinite weights fail one of the three as well: u + v <= 1 is the upper bound.
        if (!(c.u >= 0 && c.v >= 0 && double(c.u) + double(c.v) <= 1)) ++q.outside_simplex;
        const double distance = (rows.at(x, y) - Vec2d(x, y)).norm();
        if (!std::isfinite(distance)) continue;
        ++mapped;
        q.mean_displacement += distance;
        q.max_displacement = std::max(q.max_displacement, distance);
    }
}

}  // namespace

std::vector<Vec2d> mapped_positions(const BaseMesh& mesh, const PixelMap& map) {
    std::vector<Vec2d> image = parallel_vector<Vec2d>(map.size(), Vec2d::Zero());
    parallel_blocks(0, map.height, kGrainRows, [&](int first, int last) {
        for (int y = first; y < last; ++y)
            for (int x = 0; x < map.width; ++x) image[map.index(x, y)] = position_or_nan(mesh, map.at(x, y));
    });
    return image;
}

MapQuality map_quality(const BaseMesh& mesh, const PixelMap& map, bool has_mask) {
    struct Part {
        MapQuality q;
        std::int64_t mapped = 0;
    };
    std::vector<Part> parts(as_index((map.height + kGrainRows - 1) / kGrainRows));
    parallel_blocks(0, map.height, kGrainRows, [&](int first, int last) {
        Part& part = parts[as_index(first / kGrainRows)];
        part.q.min_area2 = std::numeric_limits<double>::infinity();
        const MappedRows rows(mesh, map, first, std::min(last + 1, map.height));
        for (int y = first; y < last; ++y) {
            measure_row(rows, map.width, map.height, y, part.q);
            measure_pixels(mesh, map, rows, has_mask, y, part.q, part.mapped);
        }
    });
    MapQuality q;
    std::int64_t mapped = 0;
    q.min_area2 = std::numeric_limits<double>::infinity();
    for (const Part& part : parts) {
        q.pixels += part.q.pixels;
        q.unmapped += part.q.unmapped;
        q.outside_simplex += part.q.outside_simplex;
        q.flipped_triangles += part.q.flipped_triangles;
        q.min_area2 = std::min(q.min_area2, part.q.min_area2);
        q.max_jump = std::max(q.max_jump, part.q.max_jump);
        q.mean_displacement += part.q.mean_displacement;
        q.max_displacement = std::max(q.max_displacement, part.q.max_displacement);
        mapped += part.mapped;
    }
    if (std::isinf(q.min_area2)) q.min_area2 = 1;
    q.max_jump = std::sqrt(q.max_jump);
    if (mapped > 0) q.mean_displacement /= double(mapped);
    return q;
}

namespace {

// Computes map_rms over the features [feature_begin, feature_end).
double range_rms(const BaseMesh& mesh, const PixelMap& map, const FeatureImage& reference, int feature_begin,
                 int feature_end) {
    if (map.width != reference.width || map.height != reference.height)
        throw Error(ErrorKind::kBadArgument, cat("pixel map is ", map.width, "x", map.height,
                                                 ", reference is ", reference.width, "x", reference.height));
    if (mesh.channels != reference.channels)
        throw Error(ErrorKind::kBadArgument,
                    cat("base mesh has ", mesh.channels, " channels, reference has ", reference.channels));
    // One sum for each row, added in order: the result is the same for any number of threads.
    std::vector<double> sums(as_index(map.height));
    std::vector<std::int64_t> counts(sums.size());
    parallel_blocks(0, map.height, kGrainRows, [&](int first, int last) {
        for (int y = first; y < last; ++y) {
            const float* want = reference.pixel(0, y);
            double sum = 0;
            std::int64_t count = 0;
            for (const PixelCoord& coord : map.row(y)) {
                if (coord.face != kNone) {
                    const auto [a, b, c] = mesh.faces[coord.face];
                    const float *fa = mesh.feature_of(a), *fb = mesh.feature_of(b), *fc = mesh.feature_of(c);
                    const float u = coord.u, v = coord.v, w = 1 - u - v;
                    for (int k = feature_begin; k < feature_end; ++k) {
                        const float error = w * fa[k] + u * fb[k] + v * fc[k] - want[k];
                        sum += double(error) * double(error);
                    }
                    ++count;
                }
                want += reference.channels;
            }
            sums[as_index(y)] = sum;
            counts[as_index(y)] = count;
        }
    });
    const std::int64_t pixels = std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
    return pixels > 0 ? std::sqrt(std::accumulate(sums.begin(), sums.end(), 0.0) / double(pixels)) : 0;
}

}  // namespace

double map_rms(const BaseMesh& mesh, const PixelMap& map, const FeatureImage& reference) {
    return range_rms(mesh, map, reference, 0, mesh.channels);
}

double feature_rms(const BaseMesh& mesh, const PixelMap& map, const FeatureImage& reference, int feature) {
    return range_rms(mesh, map, reference, feature, feature + 1);
}

}  // namespace imgmesh
