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

// Of larger pictures: some thousand windows tell the density to a percent or two. Widths are in mean
// distances of vertices; an effect of the sides is not seen beyond that margin.
constexpr double kWindow = 16, kMargin = 1.6, kLeastSampled = 1.0 / 8;
constexpr int kLeastWindow = 32;  // [steps]

// The share of the pixels that is sampled.
double sampled_share(const TileGrid& grid) {
    const double pixels = static_cast<double>(grid.width()) * grid.height();
    return std::clamp(static_cast<double>(kSampledWhole) / pixels, kLeastSampled, 1.0);
}

struct VertexCounts {
    double counted = 0, on_sides = 0;
};

// Whether vertices of a part count.
class Counter {
  public:
    Counter(const GridSize& size, int margin)
        : size_(size),
          margin_(margin),
          least_(static_cast<float>(margin)),
          right_(static_cast<float>(size.width - 1 - margin)),
          bottom_(static_cast<float>(size.height - 1 - margin)) {}

    VertexCounts of(const Vec2f& place) const {
        const double on_sides = on_side(place, size_.width, size_.height) ? 1 : 0;
        if (margin_ == 0) return {1 - 0.5 * on_sides, on_sides};
        const bool within =
            least_ <= place[0] && place[0] < right_ && least_ <= place[1] && place[1] < bottom_;
        return {within ? 1.0 : 0.0, on_sides};
    }

  private:
    GridSize size_;
    int margin_;
    float least_, right_, bottom_;
};

// Collapses a part to at most so many vertices and from there to the last threshold, and returns the counts
// at each of them. A collapse that adds more than a threshold has not happened there. This is the same as to
// stop at each of them, as far as edges collapse in the order of their costs.
std::vector<VertexCounts> counts_at(std::span<const double> thresholds, const GridMesh& grid,
                                    const Counter& counter, const SimplifyParams& params, double most) {
    std::vector<VertexCounts> counts(thresholds.size());
    const auto change = [&](std::size_t from, const Vec2f& place, double by) {
        if (from == counts.size()) return;
        const VertexCounts one = counter.of(place);
        counts[from].counted += by * one.counted;
        counts[from].on_sides += by * one.on_sides;
    };
    bool counting = false;
    SimplifyHooks hooks;
    hooks.after = [&](const CollapseTaken& taken) {
        if (!counting) return;
        const auto from = static_cast<std::size_t>(std::ranges::lower_bound(thresholds, taken.increment) -
                                                   thresholds.begin());
        for (const Vec2f& end : taken.ends) change(from, end, -1);
        change(from, taken.merged, 1);
    };
    hooks.reached = [&](std::size_t level, const SimplifyResult& result) {
        if (level != 0) return;
        counting = true;
        for (const Vec2f& place : result.mesh.position) change(0, place, 1);
    };
    const SimplifyTarget targets[] = {{.vertices = std::max<std::int64_t>(4, std::llround(most))},
                                      {.vertices = 4, .max_increment = thresholds.back()}};
    simplify(grid, params, targets, {}, hooks);
    for (std::size_t i = 1; i < counts.size(); ++i) {
        counts[i].counted += counts[i - 1].counted;
        counts[i].on_sides += counts[i - 1].on_sides;
    }
    return counts;
}

// How many pixels are inside the mask and within the margin; without a mask steps.
double counted_pixels(const GridSize& size, const Mask& mask, int margin) {
    if (mask.empty())
        return static_cast<double>(size.width - 1 - 2 * margin) * (size.height - 1 - 2 * margin);
    if (margin == 0) return static_cast<double>(mask.count());
    double pixels = 0;
    for (int y = margin; y < size.height - 1 - margin; ++y)
        for (int x = margin; x < size.width - 1 - margin; ++x) pixels += mask.at(x, y) ? 1 : 0;
    return pixels;
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
    add_to(counted, other.counted);
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

DensitySample sample_density(FeatureImage part, Mask mask, int margin, const SimplifyParams& params,
                             double density) {
    const std::span<const double> thresholds = sample_thresholds();
    const GridSize size = part;
    DensitySample sample;
    sample.border = 2.0 * (size.width - 1 + size.height - 1);
    sample.pixels = counted_pixels(size, mask, margin);
    for (std::vector<double>* counts : {&sample.counted, &sample.on_sides, &sample.decided})
        counts->resize(thresholds.size());
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
    const double all = counted_pixels(size, mask, 0);
    const GridMesh grid = grid_mesh(std::move(part), std::move(mask));
    const double most = std::clamp(kMostDense * density / 100, kLeastShare, kMostShare) * all;
    const std::vector<VertexCounts> counts = counts_at(thresholds, grid, Counter(size, margin), params, most);
    for (std::size_t i = 0; i < counts.size(); ++i) {
        sample.counted[i] = counts[i].counted;
        sample.on_sides[i] = counts[i].on_sides;
    }
    return sample;
}

std::vector<SampledPart> sampled_parts(const TileGrid& grid, int row, double density) {
    std::vector<SampledPart> parts;
    const double share = sampled_share(grid), apart = 10 / std::sqrt(density);
    const int window = std::max(kLeastWindow, static_cast<int>(std::lround(kWindow * apart)));
    const int margin = static_cast<int>(std::lround(kMargin / kWindow * window));
    // One window in a square of this side.
    const double spacing = window / std::sqrt(share);
    for (int column = 0; column < grid.columns(0); ++column) {
        const PixelRect rect = grid.rect({0, column, row});
        const auto cells = [&](int pixels) {
            return std::max(1, static_cast<int>(std::lround((pixels - 1) / spacing)));
        };
        const int across = cells(rect.width()), down = cells(rect.height());
        if (share == 1 || rect.width() <= window || rect.height() <= window) {
            parts.push_back({rect});
            continue;
        }
        // Somewhere in each cell, so that no pattern of the picture falls in step with the windows.
        for (int n = 0; n < across * down; ++n) {
            const auto place = [&](int begin, int pixels, int cell, int count, std::uint64_t salt) {
                const double room = static_cast<double>(pixels - 1) / count;
                const auto seed = (static_cast<std::uint64_t>(row) << 40) +
                                  (static_cast<std::uint64_t>(column) << 12) +
                                  static_cast<std::uint64_t>(2 * n) + salt + 1;
                const double free = room - window;
                return begin + static_cast<int>(cell * room +
                                                std::max(0.0, free) * scattered(seed * 0x9E3779B97F4A7C15u));
            };
            const int x = std::min(place(rect.left, rect.width(), n % across, across, 0),
                                   rect.right - window - 1),
                      y = std::min(place(rect.top, rect.height(), n / across, down, 1),
                                   rect.bottom - window - 1);
            parts.push_back({{x, y, x + window + 1, y + window + 1}, margin});
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
    // The sides of tiles have the vertices that are decided instead of those that the collapse leaves there,
    // and the picture's own border has nothing beyond it, so none of its vertices counts half.
    const auto expected = [&](std::size_t i) {
        const double own = samples.on_sides[i] / samples.border,
                     decided = samples.decided[i] / samples.border;
        return pixels * samples.counted[i] / samples.pixels + shared * (decided - own) +
               outer * (decided - 0.5 * own);
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
