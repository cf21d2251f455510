#include "libcore/warp/cell_places.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "libcore/base/parallel.h"
#include "libcore/warp/cell_raster.h"

namespace imgmesh {
namespace {

constexpr int kGrainRows = 64;

// Rounds to the nearest whole number, ties to even, for |value| < 2^31. Adding 1.5 * 2^52 leaves the number
// in the low bits. Unlike std::lrint this works on several values at once.
std::int32_t rounded(double value) {
    constexpr double kShift = 1.5 * (std::int64_t{1} << 52);
    return static_cast<std::int32_t>(std::bit_cast<std::int64_t>(value + kShift));
}

}  // namespace

CellPlaces::CellPlaces(const DisplacementField& field, int width, int height)
    : field_(field),
      scale_x_(double(width) / field.width),
      scale_y_(double(height) / field.height),
      rows_(as_index(field.height) + 2) {
    parallel_blocks(-1, field.height + 1, kGrainRows, [&](int first, int last) {
        PlaceRow places;
        for (int y = first; y < last; ++y) {
            row(y, places);
            std::int32_t low = places.y[0], high = low;
            for (const std::int32_t p : places.y) {
                low = std::min(low, p);
                high = std::max(high, p);
            }
            rows_[as_index(y + 1)] = {low, high};
        }
    });
}

void CellPlaces::row(int y, PlaceRow& out) const {
    const std::size_t width = as_index(field_.width);
    out.x.resize(width + 2);
    out.y.resize(width + 2);
    const Vec2f* move = field_.move.data() + field_.row_begin(std::clamp(y, 0, field_.height - 1));
    const double limit = kFarthest * kOne, sx = scale_x_ * kOne, sy = scale_y_ * kOne;
    const double from_x = 0.5 * sx - 0.5 * kOne, from_y = (y + 0.5) * sy - 0.5 * kOne;
    const auto place = [&](double from, double by) {
        return rounded(std::min(std::max(from + by, -limit), limit));
    };
    std::int32_t *px = out.x.data() + 1, *py = out.y.data() + 1;
    for (std::size_t x = 0; x < width; ++x) {
        px[x] = place(from_x, (double(as_int(x)) + double(move[x].x())) * sx);
        py[x] = place(from_y, double(move[x].y()) * sy);
    }
    px[-1] = place(from_x, (-1 + double(move[0].x())) * sx);
    py[-1] = py[0];
    px[width] = place(from_x, (double(field_.width) + double(move[width - 1].x())) * sx);
    py[width] = py[width - 1];
}

bool CellPlaces::reaches(int y, int first, int last) const {
    const Range &above = rows_[as_index(y + 1)], &below = rows_[as_index(y + 2)];
    return std::max(above.high, below.high) >> kBits >= first &&
           (std::min(above.low, below.low) + kOne - 1) >> kBits < last;
}

Cover CellPlaces::cover(int x, int y) const {
    const bool rim = x < 0 || y < 0 || x + 1 >= field_.width || y + 1 >= field_.height;
    if (!field_.has_mask) return rim ? Cover::kBoundary : Cover::kSolid;
    int inside = 0;
    for (int j = y; j <= y + 1; ++j)
        for (int i = x; i <= x + 1; ++i) {
            const PixelRole role = field_.role[field_.index(std::clamp(i, 0, field_.width - 1),
                                                            std::clamp(j, 0, field_.height - 1))];
            if (role == PixelRole::kOutside) return Cover::kNothing;
            inside += role == PixelRole::kInside;
        }
    return inside == 0 ? Cover::kNothing : inside == 4 && !rim ? Cover::kSolid : Cover::kBoundary;
}

}  // namespace imgmesh
