#include "libcore/segment/refine_outlines.h"

#include <array>
#include <cmath>

#include "libcore/base/dot.h"

namespace imgmesh {
namespace {

// Most pixels that ever move do so in the first three passes. Those after the sixth change no figure by more
// than .001 (docs/decisions/0010-superpixels.md).
constexpr int kPasses = 6;

// A pixel's neighbours in a circle: first the right one, then anticlockwise. Even ones share a side.
constexpr int kNeighbors = 8;
constexpr std::array<int, kNeighbors> kStepX = {1, 1, 0, -1, -1, -1, 0, 1};
constexpr std::array<int, kNeighbors> kStepY = {0, -1, -1, -1, 0, 1, 1, 1};

// Whether a region stays 4-connected without a pixel, as far as its neighbours tell. Bit k of `own` says that
// neighbour k is of the same region.
constexpr bool stays_connected(unsigned own) {
    int sides = 0, links = 0;
    for (unsigned k = 0; k < kNeighbors; k += 2) {
        const unsigned corner = k + 1, next = (k + 2) % kNeighbors;
        if (((own >> k) & 1u) == 0) continue;
        ++sides;
        if (((own >> corner) & 1u) != 0 && ((own >> next) & 1u) != 0) ++links;
    }
    // Sides linked in a chain have one link less than there are sides.
    return sides > 0 && sides - links == 1;
}

constexpr std::array<bool, 256> kStaysConnected = [] {
    std::array<bool, 256> table{};
    for (unsigned own = 0; own < table.size(); ++own) table[own] = stays_connected(own);
    return table;
}();

class Mover {
  public:
    Mover(LabelImage& labels, const FeatureImage& image, const OutlineParams& params)
        : labels_(labels),
          colors_(image),
          stride_(as_index(labels.width) + 2),
          framed_(stride_ * (as_index(labels.height) + 2), kNone),
          stale_(framed_.size(), 1),
          regions_(labels.count),
          place_scale_(params.compactness / params.spacing),
          price_(params.compactness * params.compactness),
          min_size_(double(params.min_size)) {
        for (std::size_t k = 0; k < kNeighbors; ++k) offset_[k] = kStepY[k] * as_signed(stride_) + kStepX[k];
        for (int y = 0; y < labels.height; ++y)
            for (int x = 0; x < labels.width; ++x) {
                const Id label = labels.at(x, y);
                framed_[framed(x, y)] = label;
                if (label != kNone) regions_[label].add(features(x, y), 1);
            }
    }

    void run() {
        // Every other pass runs backwards, so that outlines do not drift one way.
        for (int pass = 0; pass < kPasses; ++pass) {
            const bool back = pass % 2 == 1;
            for (int row = 0; row < labels_.height; ++row)
                for (int column = 0; column < labels_.width; ++column) {
                    const int x = back ? labels_.width - 1 - column : column,
                              y = back ? labels_.height - 1 - row : row;
                    // What has not changed nearby since the last visit is left alone.
                    if (stale_[framed(x, y)] != 0) visit(x, y);
                }
        }
        renumber();
    }

  private:
    using Features = Eigen::Matrix<double, 5, 1>;  // L*, u*, v*, x and y; the last two scaled

    struct Region {
        double pixels = 0;
        Features sum = Features::Zero();
        Features mean = Features::Zero();

        void add(const Features& pixel, int sign) {
            pixels += sign;
            sum += sign * pixel;
            mean = sum / pixels;
        }
    };

    static double distance2(const Features& a, const Features& b) {
        const Features step = a - b;
        return dot(step, step);
    }
    static std::ptrdiff_t as_signed(std::size_t n) { return static_cast<std::ptrdiff_t>(n); }

    std::size_t framed(int x, int y) const { return as_index(y + 1) * stride_ + as_index(x + 1); }

    Features features(int x, int y) const {
        const float* color = colors_.pixel(x, y);
        return {double(color[0]), double(color[1]), double(color[2]), place_scale_ * x, place_scale_ * y};
    }

    // Gives a pixel to the neighbouring region that lowers the energy most.
    void visit(int x, int y) {
        const std::size_t i = framed(x, y);
        Id* const at = framed_.data() + i;
        const Id own = *at;
        stale_[i] = 0;
        if (own == kNone) return;
        if (at[1] == own && at[-1] == own && at[stride_] == own && at[-as_signed(stride_)] == own) return;
        std::array<Id, kNeighbors> around;
        unsigned same = 0;
        for (std::size_t k = 0; k < kNeighbors; ++k) {
            around[k] = at[offset_[k]];
            same |= unsigned(around[k] == own) << k;
        }
        Region& from = regions_[own];
        if (!kStaysConnected[same] || from.pixels <= min_size_) return;
        const Features pixel = features(x, y);
        // What the pixel costs where it is: the sum of squares falls by this when it leaves.
        double least =
            from.pixels / (from.pixels - 1) * distance2(pixel, from.mean) + price_ * line_length(around, own);
        Id best = own;
        for (std::size_t k = 0; k < kNeighbors; k += 2) {
            const Id other = around[k];
            if (other == kNone || other == own || other == best) continue;
            const Region& to = regions_[other];
            const double cost =
                to.pixels / (to.pixels + 1) * distance2(pixel, to.mean) + price_ * line_length(around, other);
            if (cost >= least) continue;
            least = cost;
            best = other;
        }
        if (best == own) return;
        from.add(pixel, -1);
        regions_[best].add(pixel, 1);
        *at = best;
        for (const std::ptrdiff_t offset : offset_) stale_[as_index(as_signed(i) + offset)] = 1;
    }

    // The outline between a pixel of region `own` and its neighbours. The frame and the mask's are free.
    static double line_length(const std::array<Id, kNeighbors>& around, Id own) {
        constexpr double kDiagonal = 0.70710678118654752;
        double length = 0;
        for (std::size_t k = 0; k < kNeighbors; ++k)
            if (around[k] != own && around[k] != kNone) length += k % 2 == 0 ? 1 : kDiagonal;
        return length;
    }

    void renumber() {
        std::vector<Id> number(regions_.size(), kNone);
        Id count = 0;
        for (int y = 0; y < labels_.height; ++y)
            for (int x = 0; x < labels_.width; ++x) {
                const Id label = framed_[framed(x, y)];
                if (label != kNone && number[label] == kNone) number[label] = count++;
                labels_.at(x, y) = label == kNone ? kNone : number[label];
            }
    }

    LabelImage& labels_;
    const FeatureImage& colors_;
    std::size_t stride_;
    std::vector<Id> framed_;  // labels inside a frame of kNone, so that every pixel has eight neighbours
    std::vector<std::uint8_t> stale_;  // of the framed labels: 1 where a pixel must be visited
    std::array<std::ptrdiff_t, kNeighbors> offset_{};
    std::vector<Region> regions_;
    double place_scale_, price_, min_size_;
};

}  // namespace

void refine_outlines(LabelImage& labels, const FeatureImage& image, const OutlineParams& params) {
    Mover(labels, image, params).run();
}

}  // namespace imgmesh
