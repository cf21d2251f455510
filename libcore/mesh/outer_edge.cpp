#include "libcore/mesh/outer_edge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "libcore/base/parallel.h"
#include "libcore/mesh/adjacency.h"
#include "libcore/mesh/stretch.h"
#include "libcore/mesh/unfolded_moves.h"

namespace imgmesh {
namespace {

// An edge with one face. Inside is on its left on screen.
struct BoundaryEdge {
    Id from, to;
    Vec2d normal;      // outwards, of length 1
    double shift = 0;  // how far outwards the edge must move
};

std::vector<BoundaryEdge> boundary_edges(const BaseMesh& mesh) {
    struct Side {
        Id low, high;
        bool falls;  // runs from high to low
    };
    std::vector<Side> sides;
    sides.reserve(3 * mesh.faces.size());
    for (const Face& face : mesh.faces)
        for (std::size_t i = 0; i < 3; ++i) {
            const Id a = face[i], b = face[(i + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), a > b});
        }
    const auto key = [](const Side& s) { return std::pair(s.low, s.high); };
    std::sort(sides.begin(), sides.end(), [&](const Side& a, const Side& b) { return key(a) < key(b); });
    std::vector<BoundaryEdge> edges;
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t end = i + 1;
        while (end < sides.size() && key(sides[end]) == key(sides[i])) ++end;
        if (end == i + 1) {
            BoundaryEdge edge{sides[i].low, sides[i].high, {}};
            if (sides[i].falls) std::swap(edge.from, edge.to);
            const Vec2d along = (mesh.position[edge.to] - mesh.position[edge.from]).cast<double>();
            edge.normal = Vec2d(-along.y(), along.x()) / along.norm();
            edges.push_back(edge);
        }
        i = end;
    }
    return edges;
}

// Returns how far the squares of pixels reach beyond an edge. Their centres are on its inner side, or on it.
double needed_shift(const Vec2d& a, const Vec2d& b, const Vec2d& normal, const PixelMap& map) {
    // Half the extent of a pixel along the normal.
    const double half = 0.5 * (std::abs(normal.x()) + std::abs(normal.y()));
    // A square beside an end of the edge may reach over the line on this side of the corner's bisector. Two
    // half diagonals are enough for corners above a right angle; below it, squares do not lie beyond the end.
    constexpr double kBeyond = 1.5;
    constexpr double kOn = 1e-6;  // rounding of exact halves
    const double length = (b - a).norm();
    const Vec2d along = (b - a) / length;
    double least = half;  // distance of a centre from the line, inwards
    const auto bound = [](double x, int most) { return static_cast<int>(std::clamp(x, 0.0, double(most))); };
    const int top = bound(std::floor(std::min(a.y(), b.y()) - kBeyond), map.height - 1),
              bottom = bound(std::ceil(std::max(a.y(), b.y()) + kBeyond), map.height - 1);
    for (int y = top; y <= bottom; ++y) {
        double left = std::min(a.x(), b.x()) - kBeyond, right = std::max(a.x(), b.x()) + kBeyond;
        // Only pixels with -half < normal . (q - a) <= 0 count: a short part of the row unless it runs along.
        if (std::abs(normal.x()) > 1e-3) {
            const double at_line = a.x() - normal.y() * (y - a.y()) / normal.x(),
                         inwards = at_line - half / normal.x();
            left = std::max(left, std::min(at_line, inwards) - 1);
            right = std::min(right, std::max(at_line, inwards) + 1);
        }
        if (right < 0 || left > map.width - 1) continue;
        for (int x = bound(std::floor(left), map.width - 1); x <= bound(std::ceil(right), map.width - 1);
             ++x) {
            if (map.at(x, y).face == kNone) continue;
            const Vec2d q = Vec2d(x, y) - a;
            const double inwards = -normal.dot(q), at = along.dot(q);
            if (inwards < -kOn || inwards >= least || at < -kBeyond || at > length + kBeyond) continue;
            least = std::max(inwards, 0.0);
        }
    }
    return half - least;
}

// The edges before and after a vertex of the boundary.
struct Corner {
    const BoundaryEdge *in = nullptr, *out = nullptr;
    bool simple = true;  // one of each

    bool reached_by(const Vec2d& move) const {
        constexpr double kSlack = 1e-7;
        return move.dot(in->normal) >= in->shift - kSlack && move.dot(out->normal) >= out->shift - kSlack;
    }
};

// Returns the shortest move after which both edges lie where they must.
Vec2d shortest_move(const Corner& corner) {
    const Vec2d &n = corner.in->normal, &m = corner.out->normal;
    const double s = corner.in->shift, t = corner.out->shift;
    for (const Vec2d& move : {Vec2d(s * n), Vec2d(t * m)})
        if (corner.reached_by(move)) return move;
    // Beyond this the corner is a needle of less than 8 degrees, or a slit.
    constexpr double kMost = 8;
    const double det = n.x() * m.y() - n.y() * m.x();
    if (std::abs(det) < 1e-9) return {0, 0};
    const Vec2d move((s * m.y() - t * n.y()) / det, (t * n.x() - s * m.x()) / det);
    return move.norm() <= kMost ? move : Vec2d(move * (kMost / move.norm()));
}

// Rounds to the grid of positions, to a near place from where both edges are still reached.
Vec2f snapped_move(const Vec2f& from, const Vec2d& move, const Corner& corner) {
    const Vec2d to = (from.cast<double>() + move) / double{kPositionStep};
    const Vec2d base(std::floor(to.x() + 1e-6), std::floor(to.y() + 1e-6));
    Vec2d best = base;
    double least = std::numeric_limits<double>::infinity();
    for (int dy = -1; dy <= 2; ++dy)
        for (int dx = -1; dx <= 2; ++dx) {
            const Vec2d place = base + Vec2d(dx, dy);
            const Vec2d moved = place * double{kPositionStep} - from.cast<double>();
            if (!corner.reached_by(moved) || moved.squaredNorm() >= least) continue;
            least = moved.squaredNorm();
            best = place;
        }
    return (best * double{kPositionStep}).cast<float>();
}

// Moves the corners of faces that have turned over back, half the way each time.
void unfold(const BaseMesh& mesh, std::vector<Vec2f>& position) {
    constexpr int kHalvings = 8;  // of at most 8 pixels: then a step of the grid
    constexpr int kMostRounds = 64;
    for (int round = 0;; ++round) {
        std::vector<Id> back;
        for (const auto& [a, b, c] : mesh.faces)
            if (!(signed_area2(position[a], position[b], position[c]) > 0))
                back.insert(back.end(), {a, b, c});
        if (back.empty()) return;
        if (round > kMostRounds) {
            position = mesh.position;
            return;
        }
        std::sort(back.begin(), back.end());
        back.erase(std::unique(back.begin(), back.end()), back.end());
        for (const Id v : back) {
            const Vec2f move = round < kHalvings ? Vec2f((position[v] - mesh.position[v]) / 2) : Vec2f(0, 0);
            position[v] = {snapped(mesh.position[v].x() + move.x()),
                           snapped(mesh.position[v].y() + move.y())};
        }
    }
}

// Whether a triangle and the square of pixel (x, y) share area: no line parallel to a side parts them.
bool overlaps(const std::array<Vec2d, 3>& t, int x, int y) {
    const Vec2d middle(x, y);
    const auto parts = [&](const Vec2d& axis) {
        const double half = 0.5 * (std::abs(axis.x()) + std::abs(axis.y())), at = axis.dot(middle);
        const double a = axis.dot(t[0]), b = axis.dot(t[1]), c = axis.dot(t[2]);
        constexpr double kTouch = 1e-9;
        return std::max({a, b, c}) <= at - half + kTouch || std::min({a, b, c}) >= at + half - kTouch;
    };
    if (parts({1, 0}) || parts({0, 1})) return false;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec2d side = t[(i + 1) % 3] - t[i];
        if (side.squaredNorm() > 0 && parts({-side.y(), side.x()})) return false;
    }
    return true;
}

bool holds_pixels(const std::array<Vec2d, 3>& t, const PixelMap& map) {
    const auto low = [](double x) { return std::max(static_cast<int>(std::floor(x + 0.5)), 0); };
    const double top = std::min({t[0].y(), t[1].y(), t[2].y()}),
                 bottom = std::max({t[0].y(), t[1].y(), t[2].y()});
    for (int y = low(top); y <= std::min(low(bottom), map.height - 1); ++y) {
        // The part of the triangle in this row of squares.
        double left = std::numeric_limits<double>::infinity(), right = -left;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec2d &a = t[i], &b = t[(i + 1) % 3];
            for (const double at : {std::clamp(y - 0.5, std::min(a.y(), b.y()), std::max(a.y(), b.y())),
                                    std::clamp(y + 0.5, std::min(a.y(), b.y()), std::max(a.y(), b.y()))}) {
                const double x =
                    a.y() == b.y() ? a.x() : a.x() + (b.x() - a.x()) * (at - a.y()) / (b.y() - a.y());
                left = std::min({left, x, a.y() == b.y() ? b.x() : x});
                right = std::max({right, x, a.y() == b.y() ? b.x() : x});
            }
        }
        for (int x = low(left); x <= std::min(low(right), map.width - 1); ++x)
            if (map.at(x, y).face != kNone && overlaps(t, x, y)) return true;
    }
    return false;
}

// A coordinate itself, and those of the lines between pixels within a pixel and a half.
std::array<float, 5> near_lines(float x) {
    const float line = std::floor(x + 0.5f) - 0.5f;
    return {x, line - 1, line, line + 1, line + 2};
}

// Moves vertices back onto lines between pixels where that gives up no pixel: a rectangle becomes one,
// although the collapse has let its sides bulge.
void tighten(const BaseMesh& mesh, const PixelMap& map, const std::vector<Corner>& corners,
             std::vector<Vec2f>& position) {
    const VertexCorners faces = vertex_corners(mesh.faces, mesh.vertex_count());
    const auto keeps_faces = [&](Id v, const Vec2f& to) {
        for (const std::size_t corner : faces.of(v)) {
            const Face& face = mesh.faces[corner / 3];
            std::array<Vec2f, 3> p = {position[face[0]], position[face[1]], position[face[2]]};
            p[corner % 3] = to;
            if (!(signed_area2(p[0], p[1], p[2]) > 0)) return false;
        }
        return true;
    };
    const auto improve = [&](Id v) {
        const Vec2f a = position[corners[v].in->from], b = position[corners[v].out->to], from = position[v];
        double most = 0;
        Vec2f best = from;
        for (const float x : near_lines(from.x()))
            for (const float y : near_lines(from.y())) {
                const Vec2f to(x, y);
                const double first = signed_area2(a, from, to), second = signed_area2(from, b, to);
                if (first < 0 || second < 0 || first + second <= most || !keeps_faces(v, to)) continue;
                const Vec2d p = a.cast<double>(), q = from.cast<double>(), r = b.cast<double>(),
                            s = to.cast<double>();
                if (holds_pixels({p, q, s}, map) || holds_pixels({q, r, s}, map)) continue;
                most = first + second;
                best = to;
            }
        position[v] = best;
        return most > 0;
    };
    constexpr int kMostPasses = 16;
    bool any = true;
    for (int pass = 0; any && pass < kMostPasses; ++pass) {
        any = false;
        for (Id v = 0; v < mesh.vertex_count(); ++v)
            if (corners[v].in && corners[v].out && corners[v].simple) any |= improve(v);
    }
}

}  // namespace

std::vector<Vec2f> outer_positions(const BaseMesh& mesh, const PixelMap& map) {
    std::vector<BoundaryEdge> edges = boundary_edges(mesh);
    parallel_blocks(0, as_int(edges.size()), 64, [&](int begin, int end) {
        for (std::size_t e = as_index(begin); e < as_index(end); ++e)
            edges[e].shift = needed_shift(mesh.position[edges[e].from].cast<double>(),
                                          mesh.position[edges[e].to].cast<double>(), edges[e].normal, map);
    });
    std::vector<Corner> corners(mesh.vertex_count());
    const auto set = [](const BoundaryEdge*& place, const BoundaryEdge& edge, bool& simple) {
        if (place) simple = false;
        place = &edge;
    };
    for (const BoundaryEdge& edge : edges) {
        set(corners[edge.from].out, edge, corners[edge.from].simple);
        set(corners[edge.to].in, edge, corners[edge.to].simple);
    }
    std::vector<Vec2f> position = mesh.position;
    for (Id v = 0; v < mesh.vertex_count(); ++v) {
        const Corner& corner = corners[v];
        if (!corner.in || !corner.out || !corner.simple || corner.reached_by({0, 0})) continue;
        position[v] = snapped_move(mesh.position[v], shortest_move(corner), corner);
        // Beyond the image there is no texture.
        for (int i = 0; i < 2; ++i) {
            const float from = mesh.position[v][i],
                        end = static_cast<float>(i == 0 ? map.width : map.height) - 0.5f;
            if (from >= -0.5f && from <= end) position[v][i] = std::clamp(position[v][i], -0.5f, end);
        }
    }
    unfold(mesh, position);
    tighten(mesh, map, corners, position);
    return position;
}

void cover_whole_pixels(MeshImage& mesh_image) {
    for (Level& level : mesh_image.levels) level.mesh.position = outer_positions(level.mesh, level.map);
}

void extend_to_outer_edge(MeshImage& mesh_image) {
    for (Level& level : mesh_image.levels) {
        std::optional<std::vector<Vec2f>> position;
        if (!mesh_image.source.has_mask) position = stretched_positions(level.mesh, level.map);
        if (!position) {
            position = outer_positions(level.mesh, level.map);
            take_back_folds(level.mesh, level.map, *position);
        }
        level.mesh.position = std::move(*position);
    }
}

}  // namespace imgmesh
