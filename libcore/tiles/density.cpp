#include "libcore/tiles/density.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "libcore/base/error.h"
#include "libcore/mesh/grid_mesh.h"
#include "libcore/mesh/tile_sides.h"
#include "libcore/pipeline/params.h"
#include "libcore/simplify/simplify.h"
#include "libcore/tiles/line_segments.h"

namespace imgmesh {
namespace {

constexpr int kThresholds = 96;
// 2^-16 to 2^31.5: below the noise of 16-bit samples, and above black and white halves of a tile.
constexpr int kFirstPower = -16;

// A part may keep so many times the wanted density; what is above counts as that. Few parts of few pictures
// have more, and the first part of the collapse takes the most time.
constexpr double kMostDense = 8, kLeastShare = 0.1, kMostShare = 0.5;

// Of larger pictures: some thousand windows tell the density to a percent or two.
constexpr int kWindow = 128;  // [steps]
constexpr double kLeastSampled = 1.0 / 8;

// One window in a square of this side.
double window_spacing(const TileGrid& grid) {
    const double pixels = static_cast<double>(grid.width()) * grid.height();
    return kWindow / std::sqrt(std::clamp(static_cast<double>(kSampledWhole) / pixels, kLeastSampled, 1.0));
}

double side_vertices(const BaseMesh& mesh, const GridSize& size) {
    return static_cast<double>(std::ranges::count_if(
        mesh.position, [&](const Vec2f& place) { return on_side(place, size.width, size.height); }));
}

// The pixels of a column.
std::vector<float> column_of(const FeatureImage& image, int x) {
    std::vector<float> line;
    for (int y = 0; y < image.height; ++y)
        line.insert(line.end(), image.pixel(x, y), image.pixel(x, y) + image.channels);
    return line;
}

// A number in [0, 1) that looks random, the same on every machine.
double scattered(std::uint64_t n) {
    n = (n ^ (n >> 30)) * 0xBF58476D1CE4E5B9u;
    n = (n ^ (n >> 27)) * 0x94D049BB133111EBu;
    return static_cast<double>((n ^ (n >> 31)) >> 11) * 0x1p-53;
}

// Logarithms differ in their last bits from machine to machine. The threshold needs ten.
double rounded(double threshold) {
    int exponent = 0;
    const double mantissa = std::frexp(threshold, &exponent);
    return std::ldexp(std::round(mantissa * 1024), exponent - 10);
}

template <class Values>
void add_to(std::vector<double>& sum, const Values& values) {
    sum.resize(std::max(sum.size(), values.size()));
    for (std::size_t i = 0; i < values.size(); ++i) sum[i] += values[i];
}

}  // namespace

SimplifyParams tile_collapse(const BuildParams& params, const TileCommon& common) {
    constexpr double kPixels = 1e6;
    return collapse_params(params, {.vertices = std::llround(kPixels * common.density / 100)}, kPixels);
}

void DensitySample::add(const DensitySample& other) {
    pixels += other.pixels;
    border += other.border;
    add_to(inner, other.inner);
    add_to(on_sides, other.on_sides);
    add_to(decided, other.decided);
}

std::span<const double> sample_thresholds() {
    static const std::array<double, kThresholds> thresholds = [] {
        std::array<double, kThresholds> all{};
        for (int i = 0; i < kThresholds; ++i)
            all[static_cast<std::size_t>(i)] =
                std::ldexp(i % 2 == 0 ? 1.0 : 1.4142135623730951, kFirstPower + i / 2);
        return all;
    }();
    return thresholds;
}

DensitySample sample_density(FeatureImage part, Mask mask, const SimplifyParams& params, double density) {
    const std::span<const double> thresholds = sample_thresholds();
    const GridSize size = part;
    DensitySample sample;
    sample.border = 2.0 * (size.width - 1 + size.height - 1);
    sample.pixels = mask.empty() ? static_cast<double>(size.width - 1) * (size.height - 1)
                                 : static_cast<double>(mask.count());
    sample.inner.resize(thresholds.size());
    sample.on_sides.resize(thresholds.size());
    sample.decided.resize(thresholds.size());
    if (size.width < 2 || size.height < 2 || sample.pixels == 0) return sample;
    std::array<std::vector<float>, 4> lines;
    lines[0].assign(part.row(0).begin(), part.row(0).end());
    lines[1].assign(part.row(size.height - 1).begin(), part.row(size.height - 1).end());
    lines[2] = column_of(part, 0);
    lines[3] = column_of(part, size.width - 1);
    for (const std::vector<float>& line : lines) {
        const std::vector<int> counts = line_vertex_counts(line, part.channels, thresholds);
        for (std::size_t i = 0; i < counts.size(); ++i) sample.decided[i] += counts[i] - 1;
    }
    const GridMesh grid = grid_mesh(std::move(part), std::move(mask));
    SimplifyRun run(grid, params);
    const double most = std::clamp(kMostDense * density / 100, kLeastShare, kMostShare) * sample.pixels;
    SimplifyResult reached = run.to({.vertices = std::max<std::int64_t>(4, std::llround(most))});
    double on_sides = side_vertices(reached.mesh, size);
    for (std::size_t i = 0; i < thresholds.size(); ++i) {
        if (reached.increment < thresholds[i] && reached.mesh.vertex_count() > 4) {
            reached = run.to({.vertices = 4, .max_increment = thresholds[i]});
            on_sides = side_vertices(reached.mesh, size);
        }
        sample.inner[i] = static_cast<double>(reached.mesh.vertex_count()) - on_sides;
        sample.on_sides[i] = on_sides;
    }
    return sample;
}

std::vector<PixelRect> sampled_parts(const TileGrid& grid, int row) {
    std::vector<PixelRect> parts;
    const double spacing = window_spacing(grid);
    const bool whole = std::int64_t{grid.width()} * grid.height() <= kSampledWhole;
    for (int column = 0; column < grid.columns(0); ++column) {
        const PixelRect rect = grid.rect({0, column, row});
        const auto cells = [&](int pixels) {
            return std::max(1, static_cast<int>(std::lround((pixels - 1) / spacing)));
        };
        const int across = cells(rect.width()), down = cells(rect.height());
        if (whole || rect.width() <= kWindow || rect.height() <= kWindow) {
            parts.push_back(rect);
            continue;
        }
        // Somewhere in each cell, so that no pattern of the picture falls in step with the windows.
        for (int n = 0; n < across * down; ++n) {
            const auto place = [&](int begin, int pixels, int cell, int count, std::uint64_t salt) {
                const double room = static_cast<double>(pixels - 1) / count;
                const auto seed = (static_cast<std::uint64_t>(row) << 40) +
                                  (static_cast<std::uint64_t>(column) << 12) +
                                  static_cast<std::uint64_t>(2 * n) + salt + 1;
                const double free = room - kWindow;
                return begin + static_cast<int>(cell * room +
                                                std::max(0.0, free) * scattered(seed * 0x9E3779B97F4A7C15u));
            };
            const int x = std::min(place(rect.left, rect.width(), n % across, across, 0),
                                   rect.right - kWindow - 1),
                      y = std::min(place(rect.top, rect.height(), n / across, down, 1),
                                   rect.bottom - kWindow - 1);
            parts.push_back({x, y, x + kWindow + 1, y + kWindow + 1});
        }
    }
    return parts;
}

double threshold_for(const DensitySample& samples, const TileGrid& grid, double vertices) {
    const std::span<const double> thresholds = sample_thresholds();
    if (samples.pixels == 0) throw Error(ErrorKind::kUnsupported, "no pixel of the picture is meshed");
    const double pixels = static_cast<double>(grid.width()) * grid.height();
    const double outer = 2.0 * (grid.width() + grid.height());
    const double shared = static_cast<double>(grid.width()) * (grid.rows(0) - 1) +
                          static_cast<double>(grid.height()) * (grid.columns(0) - 1);
    // A side of a part has half of its vertices for itself: the other half stands for what lies beyond. The
    // sides of tiles have those that are decided instead, and the picture's own border has nothing beyond.
    const auto expected = [&](std::size_t i) {
        const double own = samples.on_sides[i] / samples.border,
                     decided = samples.decided[i] / samples.border;
        const double inside = (samples.inner[i] + 0.5 * samples.on_sides[i]) / samples.pixels;
        return pixels * inside + shared * (decided - own) + outer * (decided - 0.5 * own);
    };
    if (expected(0) <= vertices) return thresholds[0];
    for (std::size_t i = 1; i < thresholds.size(); ++i) {
        const double before = expected(i - 1), here = expected(i);
        if (here > vertices) continue;
        const double share =
            (std::log2(before) - std::log2(vertices)) / (std::log2(before) - std::log2(here));
        return rounded(std::exp2(std::log2(thresholds[i - 1]) + 0.5 * share));
    }
    return thresholds.back();
}

}  // namespace imgmesh
