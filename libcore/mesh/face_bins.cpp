#include "libcore/mesh/face_bins.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libcore/base/error.h"

namespace imgmesh {
namespace {

// A face as large as half a bin reaches into 3 or 4 bins, so a bin lists about 7; with the slimmest faces of
// real meshes about 20.
constexpr std::size_t kMostListed = 64, kFreeListed = 1 << 16;

struct Span {
    double low = std::numeric_limits<double>::infinity(), high = -low;

    void add(double x) {
        low = std::min(low, x);
        high = std::max(high, x);
    }
};

// Where the side from p to q is between top and bottom.
void add_side(GridPoint p, GridPoint q, double top, double bottom, Span& span) {
    if (p.y > q.y) std::swap(p, q);
    if (q.y < top || p.y > bottom) return;
    const double slope = q.y > p.y ? (double(q.x) - p.x) / (double(q.y) - p.y) : 0;
    span.add(p.y >= top ? p.x : p.x + slope * (top - p.y));
    span.add(q.y <= bottom ? q.x : p.x + slope * (bottom - p.y));
    if (p.y == q.y) span.add(q.x);
}

// Far beyond every position, but with room for additions [units].
constexpr double kFar = 1 << 28;

}  // namespace

FaceBins::FaceBins(const BaseMesh& mesh, const GridSize& image) : faces_(exact_faces(mesh)) {
    choose_size(image);
    fill(mesh);
}

void FaceBins::choose_size(const GridSize& image) {
    const auto count = [&](int side, int shift) { return ((side * kPixelUnits - 1) >> shift) + 1; };
    const auto most = static_cast<std::int64_t>(std::max<std::size_t>(1, faces_.size() / 2));
    while (true) {
        columns_ = count(image.width, shift_x_);
        rows_ = count(image.height, shift_y_);
        if (std::int64_t{columns_} * rows_ <= most) return;
        ++(shift_x_ <= shift_y_ ? shift_x_ : shift_y_);
    }
}

void FaceBins::fill(const BaseMesh& mesh) {
    struct Listing {
        std::uint32_t bin;
        Id face;
    };
    std::vector<Listing> listings;
    const std::size_t bins = as_index(columns_) * as_index(rows_), most = kMostListed * bins + kFreeListed;
    listings.reserve(std::min(most, 8 * faces_.size()));
    const auto list = [&](Id face, int row, int first, int last) {
        if (listings.size() + as_index(last - first + 1) > most)
            throw Error(
                ErrorKind::kUnsupported,
                "the faces of the mesh are too thin or lie over one another, so no pixel can be found in "
                "them");
        for (int column = first; column <= last; ++column)
            listings.push_back({static_cast<std::uint32_t>(row * columns_ + column), face});
    };
    for (Id f = 0; f < faces_.size(); ++f) {
        if (faces_[f].area <= 0) continue;
        std::array<GridPoint, 3> corner;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec2f& at = mesh.position[mesh.faces[f][k]];
            corner[k] = {static_cast<std::int32_t>(at.x() * kPixelUnits),
                         static_cast<std::int32_t>(at.y() * kPixelUnits)};
        }
        const auto& [a, b, c] = corner;
        const int left = column_of(std::min({a.x, b.x, c.x})), right = column_of(std::max({a.x, b.x, c.x}));
        const int first = row_of(std::min({a.y, b.y, c.y})), last = row_of(std::max({a.y, b.y, c.y}));
        for (int row = first; row <= last; ++row) {
            if (right - left <= 1 || first == last) {
                list(f, row, left, right);
                continue;
            }
            // The columns that the face reaches in this row of bins, a unit more for rounding.
            const double top = row == 0 ? -kFar : double(row) * (1 << shift_y_) - kPixelUnits / 2;
            const double bottom =
                row == rows_ - 1 ? kFar : double(row + 1) * (1 << shift_y_) - kPixelUnits / 2;
            Span span;
            add_side(a, b, top, bottom, span);
            add_side(b, c, top, bottom, span);
            add_side(c, a, top, bottom, span);
            list(f, row, column_of(static_cast<int>(std::floor(span.low)) - 1),
                 column_of(static_cast<int>(std::ceil(span.high)) + 1));
        }
    }
    begin_.assign(bins + 1, 0);
    for (const Listing& listing : listings) ++begin_[listing.bin + 1];
    for (std::size_t bin = 0; bin < bins; ++bin) begin_[bin + 1] += begin_[bin];
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    listed_.resize(listings.size());
    for (const Listing& listing : listings) listed_[next[listing.bin]++] = listing.face;
}

Id FaceBins::find(GridPoint p, std::int64_t& tries) const {
    const std::size_t bin = as_index(row_of(p.y)) * as_index(columns_) + as_index(column_of(p.x));
    const std::uint32_t begin = begin_[bin], end = begin_[bin + 1];
    Id best = kNone;
    for (std::uint32_t i = begin; i < end; ++i) {
        const Id f = listed_[i];
        const SideAreas areas = faces_[f].at(p);
        if (!areas.hold()) continue;
        if (areas.hold_strictly()) {
            tries += i + 1 - begin;
            return f;
        }
        if (best == kNone || faces_[f].order < faces_[best].order) best = f;
    }
    tries += end - begin;
    return best;
}

}  // namespace imgmesh
