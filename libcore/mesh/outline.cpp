// Source of the growing outline: Sander et al. 2000, "Silhouette clipping", sec. 4.1 (progressive hulls), in
// two dimensions.
#include "libcore/mesh/outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>

#include "libcore/base/error.h"
#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/grid_area.h"

namespace imgmesh {
namespace {

constexpr double kStep = kPositionStep;
// More than any area in an image: notches at most a pixel deep go before all else.
constexpr double kStairFirst = 1e12;

// Positive if c lies to the left of a b on screen, where inside is.
double left_of(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
    return -grid_area2(a, b, c);
}

// Whether a b and c d have a point in common.
bool touch(const Vec2d& a, const Vec2d& b, const Vec2d& c, const Vec2d& d) {
    if (std::max(a.x(), b.x()) < std::min(c.x(), d.x()) || std::max(c.x(), d.x()) < std::min(a.x(), b.x()) ||
        std::max(a.y(), b.y()) < std::min(c.y(), d.y()) || std::max(c.y(), d.y()) < std::min(a.y(), b.y()))
        return false;
    const auto sign = [](double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; };
    return sign(left_of(a, b, c)) * sign(left_of(a, b, d)) <= 0 &&
           sign(left_of(c, d, a)) * sign(left_of(c, d, b)) <= 0;
}

double distance_to_segment(const Vec2d& p, const Vec2d& a, const Vec2d& b) {
    const Vec2d along = b - a;
    const double length2 = along.squaredNorm();
    const double t = length2 > 0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
    return (p - a - t * along).norm();
}

// Whether a place is within `reach` of the square of a pixel inside.
bool near_mask(const Mask& mask, const Vec2d& p, double reach) {
    const int left = static_cast<int>(std::floor(p.x() - reach + 0.5)),
              right = static_cast<int>(std::floor(p.x() + reach + 0.5)),
              top = static_cast<int>(std::floor(p.y() - reach + 0.5)),
              bottom = static_cast<int>(std::floor(p.y() + reach + 0.5));
    for (int y = top; y <= bottom; ++y)
        for (int x = left; x <= right; ++x) {
            if (!mask.at(x, y)) continue;
            const Vec2d away(std::max(std::abs(p.x() - x) - 0.5, 0.0),
                             std::max(std::abs(p.y() - y) - 0.5, 0.0));
            if (away.norm() <= reach + 1e-9) return true;
        }
    return false;
}

// Fills holes that lie wholly within `reach` of the mask. Holes join at corners, as the mask does not.
Mask without_small_holes(Mask mask, double reach) {
    Grid<std::uint8_t> seen{mask.width, mask.height, {}};
    seen.values.assign(mask.size(), 0);
    const Mask original = mask;
    std::vector<std::size_t> hole;
    for (std::size_t start = 0; start < mask.size(); ++start) {
        if (original[start] || seen[start]) continue;
        hole = {start};
        seen[start] = 1;
        bool keep = false;
        for (std::size_t k = 0; k < hole.size(); ++k) {
            const int x = mask.x_of(hole[k]), y = mask.y_of(hole[k]);
            keep = keep || x == 0 || y == 0 || x == mask.width - 1 || y == mask.height - 1;
            // The middle of a pixel is the farthest of its places in holes of one pixel; half a diagonal more
            // bounds all.
            keep = keep || !near_mask(original, Vec2d(x, y), reach);
            for (int v = std::max(y - 1, 0); v <= std::min(y + 1, mask.height - 1); ++v)
                for (int u = std::max(x - 1, 0); u <= std::min(x + 1, mask.width - 1); ++u) {
                    const std::size_t n = mask.index(u, v);
                    if (original[n] || seen[n]) continue;
                    seen[n] = 1;
                    hole.push_back(n);
                }
        }
        if (!keep)
            for (const std::size_t i : hole) mask[i] = 1;
    }
    return mask;
}

// A way to take one vertex out of the outline.
struct Removal {
    double cost = 0;              // area that is added or lost
    std::uint32_t vertex = 0;     // removed; without `merged` its neighbours are joined
    std::optional<Vec2d> merged;  // or it and the next one become this
    std::uint32_t version = 0;

    bool operator<(const Removal& other) const {  // the best is the largest
        return cost != other.cost ? cost > other.cost : vertex > other.vertex;
    }
};

class Simplifier {
  public:
    Simplifier(const Mask& mask, double tolerance, OutlineSide side)
        : mask_(mask), tolerance_(tolerance), side_(side) {
        for (const Loop& loop : mask_contours(mask)) {
            const auto first = static_cast<std::uint32_t>(at_.size()),
                       n = static_cast<std::uint32_t>(loop.size());
            for (std::uint32_t i = 0; i < n; ++i) {
                at_.push_back(loop[i]);
                next_.push_back(first + (i + 1) % n);
                previous_.push_back(first + (i + n - 1) % n);
                left_.push_back(first);
            }
            count_.resize(at_.size(), 0);
            count_[first] = n;
        }
        contour_ = at_;
        contour_next_ = next_;
        alive_.assign(at_.size(), 1);
        version_.assign(at_.size(), 0);
    }

    std::vector<Loop> run() {
        std::priority_queue<Removal> queue;
        const auto offer = [&](std::uint32_t v) {
            if (const auto removal = removal_at(v)) queue.push(*removal);
        };
        for (std::uint32_t v = 0; v < at_.size(); ++v) offer(v);
        while (!queue.empty()) {
            const Removal removal = queue.top();
            queue.pop();
            const std::uint32_t v = removal.vertex;
            if (!alive_[v] || removal.version != version_[v] || count_[left_[v]] <= 3 || blocked(removal))
                continue;
            const std::uint32_t a = previous_[v], b = next_[v];
            remove(removal);
            // What depends on the edges that have changed.
            for (std::uint32_t w : {previous_[previous_[a]], previous_[a], a, b, next_[b]}) {
                ++version_[w];
                offer(w);
            }
        }
        std::vector<Loop> loops;
        std::vector<std::uint8_t> done(at_.size(), 0);
        for (std::uint32_t v = 0; v < at_.size(); ++v) {
            if (!alive_[v] || done[v]) continue;
            Loop& loop = loops.emplace_back();
            for (std::uint32_t w = v; !done[w]; w = next_[w]) {
                done[w] = 1;
                loop.push_back(at_[w]);
            }
        }
        return loops;
    }

  private:
    // The cheaper of both ways to take v out, as far as the tolerance and the image allow; edges elsewhere
    // are looked at later, by blocked().
    std::optional<Removal> removal_at(std::uint32_t v) const {
        std::optional<Removal> best = joined(v);
        if (side_ == OutlineSide::kOut && !best) best = merged(v);
        if (best) best->version = version_[v];
        return best;
    }

    std::optional<Removal> joined(std::uint32_t v) const {
        const Vec2d &a = at_[previous_[v]], &b = at_[v], &c = at_[next_[v]];
        const double turn = left_of(a, b, c);
        if (side_ == OutlineSide::kOut ? turn > 0 || !edge_is_near(a, c)
                                       : !stands_for(previous_[v], next_[v]))
            return {};
        // Stairs first, or they would merge into larger stairs.
        const bool stair = side_ == OutlineSide::kOut && std::abs(turn) <= (c - a).norm();
        return Removal{stair ? std::abs(turn) / 2 - kStairFirst : std::abs(turn) / 2, v, {}, 0};
    }

    // v and the next one become the place where the edges before and after them meet, outside.
    std::optional<Removal> merged(std::uint32_t v) const {
        const std::uint32_t w = next_[v];
        const Vec2d &a = at_[previous_[v]], &b = at_[v], &c = at_[w], &d = at_[next_[w]];
        if (left_of(a, b, c) <= 0 || left_of(b, c, d) <= 0) return {};
        const Vec2d ab = b - a, dc = c - d;
        const double det = ab.x() * dc.y() - ab.y() * dc.x();
        if (std::abs(det) < 1e-12) return {};
        const Vec2d bc = c - b;
        const double t = (bc.x() * dc.y() - bc.y() * dc.x()) / det;
        if (!(t > 0) || t * ab.norm() > 4 * tolerance_ + 4) return {};
        const std::optional<Vec2d> m = outer_grid_place(b + t * ab, a, b, c, d);
        if (!m || !near_mask(mask_, *m, tolerance_) || !edge_is_near(a, *m) || !edge_is_near(*m, d))
            return {};
        return Removal{std::abs(left_of(b, *m, c)) / 2, v, m, 0};
    }

    // The nearest place on the grid that is inside of neither edge, and in the image.
    std::optional<Vec2d> outer_grid_place(const Vec2d& p, const Vec2d& a, const Vec2d& b, const Vec2d& c,
                                          const Vec2d& d) const {
        const Vec2d base(std::floor(p.x() / kStep), std::floor(p.y() / kStep));
        std::optional<Vec2d> best;
        double least = std::numeric_limits<double>::infinity();
        for (int y = -1; y <= 2; ++y)
            for (int x = -1; x <= 2; ++x) {
                const Vec2d q = (base + Vec2d(x, y)) * kStep;
                const bool in_image = q.x() >= -0.5 && q.y() >= -0.5 && q.x() <= mask_.width - 0.5 &&
                                      q.y() <= mask_.height - 0.5;
                if (!in_image || left_of(a, b, q) > 0 || left_of(c, d, q) > 0 || (q - p).norm() >= least)
                    continue;
                least = (q - p).norm();
                best = q;
            }
        return best;
    }

    bool edge_is_near(const Vec2d& a, const Vec2d& b) const {
        constexpr double kSample = 0.25;
        const int steps = std::max(1, static_cast<int>(std::ceil((b - a).norm() / kSample)));
        for (int i = 0; i <= steps; ++i)
            if (!near_mask(mask_, a + (b - a) * (double(i) / steps), tolerance_)) return false;
        return true;
    }

    // Whether the vertices of the contour from a to c are near the edge between them; for kBoth, which keeps
    // the contour's vertices.
    bool stands_for(std::uint32_t a, std::uint32_t c) const {
        for (std::uint32_t v = contour_next_[a]; v != c; v = contour_next_[v])
            if (distance_to_segment(contour_[v], at_[a], at_[c]) > tolerance_) return false;
        return true;
    }

    // Whether the new edges would meet others, or another loop lie in what is added.
    bool blocked(const Removal& removal) const {
        const std::uint32_t v = removal.vertex, a = previous_[v];
        const std::uint32_t w = removal.merged ? next_[v] : v, d = next_[w];
        const std::array<std::pair<Vec2d, Vec2d>, 2> edges = {
            {{at_[a], removal.merged.value_or(at_[d])}, {removal.merged.value_or(at_[a]), at_[d]}}};
        const std::size_t edge_count = removal.merged ? 2 : 1;
        const Vec2d first = at_[v], middle = removal.merged.value_or(at_[a]),
                    last = removal.merged ? at_[w] : at_[d];
        for (std::uint32_t p = 0; p < at_.size(); ++p) {
            if (!alive_[p] || p == v || p == w) continue;
            const std::uint32_t q = next_[p];
            if (p != a && p != d && inside_triangle(first, middle, last, at_[p])) return true;
            if (q == v) continue;
            for (std::size_t e = 0; e < edge_count; ++e) {
                // Edges beside share an end with the new ones, and may meet them nowhere else.
                const auto& [from, to] = edges[e];
                if (p == d ? e + 1 == edge_count : q == a && e == 0) {
                    const Vec2d &shared = p == d ? at_[d] : at_[a], &far = p == d ? at_[q] : at_[p];
                    const Vec2d& other = p == d ? from : to;
                    if (left_of(shared, far, other) == 0 && (far - shared).dot(other - shared) > 0)
                        return true;
                    continue;
                }
                if (touch(from, to, at_[p], at_[q])) return true;
            }
        }
        return false;
    }

    static bool inside_triangle(const Vec2d& a, const Vec2d& b, const Vec2d& c, const Vec2d& p) {
        if (left_of(a, b, c) == 0) return false;  // what lies on it touches its edges
        const double x = left_of(a, b, p), y = left_of(b, c, p), z = left_of(c, a, p);
        return (x >= 0 && y >= 0 && z >= 0) || (x <= 0 && y <= 0 && z <= 0);
    }

    void remove(const Removal& removal) {
        const std::uint32_t v = removal.vertex;
        if (removal.merged) {
            at_[next_[v]] = *removal.merged;
            ++version_[next_[v]];
        }
        alive_[v] = 0;
        --count_[left_[v]];
        next_[previous_[v]] = next_[v];
        previous_[next_[v]] = previous_[v];
    }

    const Mask& mask_;
    double tolerance_;
    OutlineSide side_;
    std::vector<Vec2d> at_, contour_;
    std::vector<std::uint32_t> next_, previous_, contour_next_;
    std::vector<std::uint32_t> left_;   // the first vertex of the loop, where its count is
    std::vector<std::uint32_t> count_;  // vertices that are left
    std::vector<std::uint8_t> alive_;
    std::vector<std::uint32_t> version_;
};

// Follows the edges of pixels from a corner until they come back to it, and takes them out of `leaves`.
Loop trace(Grid<std::uint8_t>& leaves, int x, int y, int first) {
    constexpr int kRight[4] = {1, 0, -1, 0}, kDown[4] = {0, -1, 0, 1};
    Loop loop;
    int u = x, v = y;
    for (int direction = first;;) {
        leaves.at(u, v) = static_cast<std::uint8_t>(leaves.at(u, v) & ~(1 << direction));
        u += kRight[direction];
        v += kDown[direction];
        // Left first: pixels that touch at a corner stay apart.
        int next = direction;
        bool closed = false;
        for (const int turn : {1, 0, 3}) {
            next = (direction + turn) % 4;
            closed = u == x && v == y && next == first;
            if (closed || leaves.at(u, v) >> next & 1) break;
        }
        if (next != direction) loop.emplace_back(u - 0.5, v - 0.5);
        if (closed) return loop;
        direction = next;
    }
}

}  // namespace

std::vector<Loop> mask_contours(const Mask& mask) {
    // At every corner of pixels, the directions in which an edge leaves it: right, up, left, down on screen.
    Grid<std::uint8_t> leaves{mask.width + 1, mask.height + 1, {}};
    leaves.values.assign(leaves.pixel_count(), 0);
    const auto add = [&](int x, int y, int direction) {
        leaves.at(x, y) = static_cast<std::uint8_t>(leaves.at(x, y) | 1 << direction);
    };
    for (int y = 0; y < mask.height; ++y)
        for (int x = 0; x < mask.width; ++x) {
            if (!mask.at(x, y)) continue;
            if (!mask.at(x, y + 1)) add(x, y + 1, 0);
            if (!mask.at(x + 1, y)) add(x + 1, y + 1, 1);
            if (!mask.at(x, y - 1)) add(x + 1, y, 2);
            if (!mask.at(x - 1, y)) add(x, y, 3);
        }
    std::vector<Loop> loops;
    for (int y = 0; y <= mask.height; ++y)
        for (int x = 0; x <= mask.width; ++x)
            for (int first = 0; first < 4; ++first)
                if (leaves.at(x, y) >> first & 1) loops.push_back(trace(leaves, x, y, first));
    return loops;
}

std::vector<Loop> simplified_outline(const Mask& mask, double tolerance, OutlineSide side) {
    if (mask.count() == 0) throw Error(ErrorKind::kUnsupported, "no pixel is inside the mask");
    const Mask filled = without_small_holes(mask, tolerance);
    return Simplifier(filled, tolerance, side).run();
}

}  // namespace imgmesh
