#include "libcore/segment/contours/half_discs.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "libcore/segment/pair_contrasts.h"

namespace imgmesh {
namespace {

// Rings between these radii [pixels]. Small discs locate a contour, large ones tell it from texture, and
// histograms need more pixels than means. Shares: docs/decisions/0036-contours-with-texture.md.
constexpr std::array<double, 4> kRadii = {3, 5, 10, 20};
constexpr int kColorRings = 3, kFirstCodeRing = 1;  // colours up to the third radius, codes from the second
constexpr float kColorShare = 0.45f, kTextonShare = 0.35f, kPaletteShare = 0.2f;

constexpr int kDirections = 8;          // of lines that cut a disc
constexpr int kUncounted = 2 * kCodes;  // the bin of pixels outside the mask
constexpr int kBins = kUncounted + 8;   // of both histograms, in whole vectors

// The middle of L*: sums of squares about it lose less to rounding.
constexpr float kMiddle = 50;

constexpr std::size_t kWedges = 16;
constexpr int kMargin = 21;  // pixels around the image: the greatest radius, rounded up

using Counts = Eigen::Array<std::uint16_t, kBins, 1>;
using Wedges = std::array<Eigen::Array<float, 8, 1>, kWedges>;
using Histograms = std::array<Counts, kWedges>;

// The half on one side of a line, wedges direction .. direction + 7, and the other half.
template <typename T>
std::pair<T, T> halves(const std::array<T, kWedges>& wedges, std::size_t direction) {
    std::pair<T, T> sides = {T::Zero(), T::Zero()};
    for (std::size_t k = 0; k < kWedges / 2; ++k) {
        sides.first += wedges[(k + direction) % kWedges];
        sides.second += wedges[(k + direction + kWedges / 2) % kWedges];
    }
    return sides;
}

// Half the sum of (a - b)^2 / (a + b) over the bins of two histograms that are first made to sum to 1.
float chi_square(const std::uint16_t* a, const std::uint16_t* b) {
    int total_a = 0, total_b = 0;
    for (std::size_t k = 0; k < kCodes; ++k) total_a += a[k], total_b += b[k];
    if (total_a == 0 || total_b == 0) return 0;
    float sum = 0;
    for (std::size_t k = 0; k < kCodes; ++k) {
        const float p = float(a[k]) / float(total_a), q = float(b[k]) / float(total_b);
        if (p + q > 0) sum += (p - q) * (p - q) / (p + q);
    }
    return sum / 2;
}

}  // namespace

HalfDiscs::Disc HalfDiscs::disc(bool down) const {
    std::array<std::vector<Offset>, kRadii.size()> rings;
    for (int dy = -kMargin; dy <= kMargin; ++dy)
        for (int dx = -kMargin; dx <= kMargin; ++dx) {
            const double x = down ? dx : dx - 0.5, y = down ? dy - 0.5 : dy;
            const auto ring = std::lower_bound(kRadii.begin(), kRadii.end(), std::hypot(x, y));
            if (ring == kRadii.end()) continue;
            const double turn = std::atan2(y, x) / (2 * std::numbers::pi);
            const auto wedge = as_index(static_cast<int>(std::floor(turn * kWedges + 1e-9)) & (kWedges - 1));
            rings[as_index(ring - kRadii.begin())].push_back(
                {std::ptrdiff_t{dy} * bins_.width + dx, wedge, wedge * kBins});
        }
    Disc disc;
    for (std::size_t k = 0; k < rings.size(); ++k) {
        disc.offsets.insert(disc.offsets.end(), rings[k].begin(), rings[k].end());
        disc.ring_end[k] = disc.offsets.size();
    }
    return disc;
}

HalfDiscs::HalfDiscs(const SmallImage& image) {
    const Codes texture = textons(image), colors = palette(image);
    const GridSize outer{image.inside.width + 2 * kMargin, image.inside.height + 2 * kMargin};
    sums_ = Grid<Sums>(outer, Sums::Zero());
    bins_ = Grid<Bins>(outer, {kUncounted, kUncounted});
    for (std::size_t i = 0; i < image.inside.size(); ++i) {
        if (!image.inside[i]) continue;
        const float* luv = image.luv.pixel(i);
        const float l = luv[0] - kMiddle, u = luv[1], v = luv[2];
        const std::size_t at = outer.index(image.inside.x_of(i) + kMargin, image.inside.y_of(i) + kMargin);
        sums_[at] << 1, l, u, v, l * l, u * u, v * v, 0;
        bins_[at] = {texture[i], static_cast<std::uint8_t>(kCodes + colors[i])};
    }
    discs_ = {disc(false), disc(true)};
}

float HalfDiscs::contrast(const Crack& crack, double normal) const {
    // The lines that cut the disc lie across the normal.
    const double at = (normal / std::numbers::pi + 0.5) * kDirections;
    const double low = std::floor(at);
    const auto share = static_cast<float>(at - low);
    const auto first = as_index(static_cast<int>(low) & (kDirections - 1));
    const std::array<std::pair<std::size_t, float>, 2> cuts = {std::pair(first, 1 - share),
                                                               std::pair((first + 1) % kDirections, share)};

    Wedges sums;
    sums.fill(Sums::Zero());
    Histograms histograms;
    histograms.fill(Counts::Zero());
    std::uint16_t* const counts = histograms[0].data();
    const std::size_t centre = bins_.index(crack.x + kMargin, crack.y + kMargin);
    const Sums* const center_sums = sums_.values.data() + centre;
    const Bins* const center_bins = bins_.values.data() + centre;
    float color = 0, texture = 0, palette = 0;
    const Disc& disc = discs_[crack.down ? 1 : 0];
    std::size_t next = 0;
    for (int ring = 0; ring < as_int(kRadii.size()); ++ring) {
        const std::size_t ring_begin = next, ring_end = disc.ring_end[as_index(ring)];
        if (ring < kColorRings)
            for (std::size_t k = ring_begin; k < ring_end; ++k)
                sums[disc.offsets[k].wedge] += center_sums[disc.offsets[k].pixel];
        for (; next < ring_end; ++next) {
            const Offset& offset = disc.offsets[next];
            const Bins bins = center_bins[offset.pixel];
            ++counts[offset.histograms + bins.texton];
            ++counts[offset.histograms + bins.color];
        }
        for (const auto& [direction, weight] : cuts) {
            if (weight == 0) continue;
            if (ring < kColorRings) {
                const auto [a, b] = halves(sums, direction);
                if (a[0] > 0 && b[0] > 0) color += weight * sums_contrast(a.data(), b.data());
            }
            if (ring >= kFirstCodeRing) {
                const auto [a, b] = halves(histograms, direction);
                texture += weight * chi_square(a.data(), b.data());
                palette += weight * chi_square(a.data() + kCodes, b.data() + kCodes);
            }
        }
    }
    const auto code_rings = float(as_int(kRadii.size()) - kFirstCodeRing);
    return kColorShare * color / float(kColorRings) + kTextonShare * texture / code_rings +
           kPaletteShare * palette / code_rings;
}

}  // namespace imgmesh
