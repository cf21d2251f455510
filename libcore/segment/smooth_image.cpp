// Two passes of a window around each pixel (smoothing_window.h). The first averages pixels of similar colour
// and makes a guide with little noise. The second fits planes to the image's own pixels, by weights that
// compare the guide's colours.
#include "libcore/segment/smooth_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "libcore/base/error.h"
#include "libcore/base/parallel.h"
#include "libcore/image/cie.h"
#include "libcore/segment/segment.h"
#include "libcore/segment/smoothing_window.h"

namespace imgmesh {
namespace {

constexpr int kGrainRows = 16;

// Chosen on five Kodak images with noise of 10, 20 and 40 of 255 (docs/decisions/0037-smoothing.md,
// tests/bench/smoothing.py). A guide has a fraction of the image's noise, so differences in it count more.
constexpr double kGuideRange = 1, kRange = 0.29, kGuideSpatial = 2.5, kSpatial = 3;

// Across a contour as strong as the strength half a percent of the weight is left, across one half stronger
// nothing. The guide is made without heights: they cost time and change nothing there.
constexpr double kHeight = 0.5, kNoHeight = std::numeric_limits<double>::infinity();

// Merges below this part of the strength change weights by at most 2 percent, and are done before.
constexpr double kLeastHeight = 0.0625;

// The share of a pixel that is clear: it gives no colour to others, but keeps one.
constexpr float kLeastShare = 1e-3f;

// A sample in the units of L*: of grey, its own L*. The curves of displays are close to that of L*.
float to_lightness(float sample, bool linear) {
    if (!linear) return 100 * sample;
    const double y = std::abs(double(sample));
    return static_cast<float>(
        std::copysign(y > kLinearLimit ? 116 * std::cbrt(y) - 16 : kLinearSlope * y, double(sample)));
}

float from_lightness(float lightness, bool linear) {
    if (!linear) return std::clamp(lightness / 100, 0.0f, 1.0f);
    const double l = std::max(0.0, double(lightness)), root = (l + 16) / 116;
    return static_cast<float>(l > kLinearSlope * kLinearLimit ? root * root * root : l / kLinearSlope);
}

// Where an image's colour and alpha are.
struct Channels {
    std::array<int, 3> color;
    int alpha;

    explicit Channels(const Image& image)
        : color{image.channel("R"), image.channel("G"), image.channel("B")}, alpha(image.channel("A")) {
        if (std::ranges::find(color, -1) != color.end()) color.fill(image.channel("Y"));
        if (color[0] < 0)
            throw Error(ErrorKind::kUnsupported, "the image has no colour: neither channels R, G, B nor Y");
    }
};

// Fills planes of the image's colour and of the pixels' shares.
PaddedPlanes padded(const Image& image, const Channels& channels, const PixelMap& map) {
    PaddedPlanes planes(image, 4);
    const bool linear = image.color_space == ColorSpace::kLinear;
    parallel_blocks(0, image.height, kGrainRows, [&](int first, int last) {
        for (int y = first; y < last; ++y)
            for (int x = 0; x < image.width; ++x) {
                const float* in = image.pixel(x, y);
                const std::size_t i = planes.index(x, y);
                for (std::size_t c = 0; c < 3; ++c)
                    planes.plane(as_int(c))[i] = to_lightness(in[channels.color[c]], linear);
                const float alpha = channels.alpha < 0 ? 1 : in[channels.alpha];
                planes.plane(3)[i] = map.at(x, y).face == kNone ? 0 : std::clamp(alpha, kLeastShare, 1.0f);
            }
    });
    return planes;
}

// What lies between the pixels: the cells' heights, and where each pixel's cell is among them.
struct Borders {
    MergeHeights heights;
    std::vector<std::int32_t> places;
};

Borders find_borders(const Level& level, const FeatureImage& features, double strength,
                     const PaddedPlanes& layout, const Progress& progress) {
    // Outlines that are smoothed for people's eyes would leave the edges of the image.
    SegmentParams params;
    params.quality = SegmentQuality::kFast;
    const Segmentation regions = segment(level, features, params, [&](double f, std::string_view stage) {
        if (progress) progress(f / 2, stage);
    });
    const Cells& cells = regions.cells;
    Borders borders{MergeHeights(regions.hierarchy, static_cast<float>(kLeastHeight * strength)), {}};
    borders.places.assign(layout.stride() * as_index(cells.height + 2 * PaddedPlanes::kMargin), -1);
    for (int y = 0; y < cells.height; ++y)
        for (int x = 0; x < cells.width; ++x)
            if (cells.at(x, y) != kNone)
                borders.places[layout.index(x, y)] =
                    static_cast<std::int32_t>(borders.heights.places()[cells.at(x, y)]);
    return borders;
}

PaddedPlanes smoothed(const Level& level, const FeatureImage& features, const PaddedPlanes& values,
                      double strength, const Progress& progress) {
    const Borders borders = find_borders(level, features, strength, values, progress);
    const SmoothingScene scene{level.map, values, borders.places, borders.heights};
    // Distances are sums of three squares: those of one channel, for grey that of L*.
    const double range = std::sqrt(3.0) * strength;
    if (progress) progress(0.5, "guide");
    const PaddedPlanes guide =
        smooth_planes(scene, values, {kGuideRange * range, kNoHeight, kGuideSpatial}, false);
    if (progress) progress(0.7, "smooth");
    return smooth_planes(scene, guide, {kRange * range, kHeight * strength, kSpatial}, true);
}

}  // namespace

Image smooth_image(const Level& level, const FeatureImage& features, const Image& image, double strength,
                   const Progress& progress) {
    if (!(strength >= 0 && strength <= kMostStrength))
        throw Error(ErrorKind::kBadArgument,
                    cat("strength is ", strength, ", expected 0 to ", kMostStrength));
    if (GridSize(image) != GridSize(level.map))
        throw Error(ErrorKind::kBadArgument,
                    cat("the image has ", image.width, "x", image.height, " pixels, the map ",
                        level.map.width, "x", level.map.height));
    const Channels channels(image);
    const auto outside = [](const PixelCoord& coord) { return coord.face == kNone; };
    const bool clear = channels.alpha >= 0 || std::ranges::any_of(level.map, outside);
    PaddedPlanes values = padded(image, channels, level.map);
    if (strength > 0) values = smoothed(level, features, values, strength, progress);

    Image out = make_image(image.width, image.height, clear ? 4 : 3);
    out.color_space = image.color_space;
    out.sample_type = image.sample_type;
    const bool linear = image.color_space == ColorSpace::kLinear;
    parallel_blocks(0, image.height, kGrainRows, [&](int first, int last) {
        for (int y = first; y < last; ++y)
            for (int x = 0; x < image.width; ++x) {
                if (outside(level.map.at(x, y))) continue;  // nobody can see what was cut off
                float* to = out.pixel(x, y);
                const std::size_t i = values.index(x, y);
                for (int c = 0; c < 3; ++c) to[c] = from_lightness(values.plane(c)[i], linear);
                if (!clear) continue;
                to[3] = channels.alpha < 0 ? 1 : image.pixel(x, y)[channels.alpha];
            }
    });
    if (progress) progress(1, "done");
    return out;
}

}  // namespace imgmesh
