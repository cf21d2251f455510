// Each pixel takes the distance of its centre from the nearest edge. A line ends in a ramp of one pixel,
// which is what it covers of a pixel that it crosses along a side, and nearly that in other directions.
#include "libcore/recon/wire_lines.h"

#include <algorithm>
#include <cmath>

#include "libcore/base/error.h"

namespace imgmesh {
namespace {

double squared_distance(const Vec2d& at, const Vec2d& p, const Vec2d& along, double inverse_length2) {
    const Vec2d from = at - p;
    const double t = std::clamp(from.dot(along) * inverse_length2, 0.0, 1.0);
    return (from - t * along).squaredNorm();
}

}  // namespace

WireLines::WireLines(const BaseMesh& mesh, std::vector<Vec2d> points, const Vec2d& size, double scale,
                     double pixels)
    : points_(std::move(points)), width_(std::sqrt(std::max(1.0, scale))) {
    // Lines along the sides of the drawing lie whole within it.
    const auto within = [](double at, double side, double half) {
        return side < 2 * half ? side / 2 : std::clamp(at, half, side - half);
    };
    for (Vec2d& p : points_) p = {within(p.x(), size.x(), width_ / 2), within(p.y(), size.y(), width_ / 2)};
    constexpr double kMostCovers = 64, kFree = 1 << 20;
    const int height = std::max(1, static_cast<int>(std::lround(size.y())));
    double length = 0, area = 0, work = 0;
    for (const auto& [a, b, c] : mesh.faces)
        area += signed_area2(mesh.position[a], mesh.position[b], mesh.position[c]) / 2;
    edges_of_band_.resize(as_index((height + kRows - 1) / kRows));
    const auto edges = mesh_edges(mesh);
    for (const auto& [a, b] : edges) {
        length += double((mesh.position[a] - mesh.position[b]).norm());
        work += (points_[a] - points_[b]).norm() * 2 * reach();
    }
    if (!(work <= kMostCovers * pixels + kFree))
        throw Error(ErrorKind::kUnsupported,
                    cat("the edges cover the image ", std::floor(work / pixels), " times over, at most ",
                        kMostCovers, " times can be drawn"));
    const double covered = length * scale * width_ / std::max(area * scale * scale, 1.0);
    opacity_ = std::min(kMostOpaque, kMostInk / covered);
    for (const auto& edge : edges) {
        const double y0 = points_[edge.first].y(), y1 = points_[edge.second].y();
        const auto band_at = [&](double y) {
            return static_cast<std::size_t>(std::clamp(y, 0.0, height - 1.0) / kRows);
        };
        for (std::size_t band = band_at(std::min(y0, y1) - reach());
             band <= band_at(std::max(y0, y1) + reach()); ++band)
            edges_of_band_[band].push_back(edge);
    }
}

void WireLines::cover(int first, int last, int width, std::span<float> ink) const {
    const double reach2 = reach() * reach();
    std::fill(ink.begin(), ink.end(), static_cast<float>(reach2));  // squared distances, at first
    for (const auto& [a, b] : edges_of_band_[as_index(first / kRows)]) {
        const Vec2d &p = points_[a], along = points_[b] - p;
        const double length2 = along.squaredNorm(), inverse = length2 > 0 ? 1 / length2 : 0;
        for (int y = first; y < last; ++y) {
            // Where the line is within reach of this row, from t0 to t1 of the edge.
            double t0 = 0, t1 = 1;
            if (along.y() != 0) {
                const double up = (y + 0.5 - reach() - p.y()) / along.y(),
                             down = (y + 0.5 + reach() - p.y()) / along.y();
                t0 = std::max(t0, std::min(up, down));
                t1 = std::min(t1, std::max(up, down));
            } else if (std::abs(y + 0.5 - p.y()) > reach()) {
                continue;
            }
            if (t0 > t1) continue;
            const double from = p.x() + t0 * along.x(), to = p.x() + t1 * along.x();
            const int begin = static_cast<int>(
                          std::clamp(std::floor(std::min(from, to) - reach()), 0.0, double(width))),
                      end = static_cast<int>(
                          std::clamp(std::ceil(std::max(from, to) + reach()), 0.0, double(width)));
            float* row = ink.data() + as_index(y - first) * as_index(width);
            for (int x = begin; x < end; ++x)
                row[x] = std::min(
                    row[x], static_cast<float>(squared_distance(Vec2d(x + 0.5, y + 0.5), p, along, inverse)));
        }
    }
    const auto opacity = static_cast<float>(opacity_), far = static_cast<float>(reach());
    for (float& value : ink) value = opacity * std::clamp(far - std::sqrt(value), 0.0f, 1.0f);
}

}  // namespace imgmesh
