#include "libcore/segment/region_outlines.h"

#include <array>
#include <unordered_map>

#include "libcore/base/error.h"
#include "libcore/segment/smooth_line.h"

namespace imgmesh {
namespace {

// Directions along pixels' edges, each a turn to the left after the one before on screen, where y grows down.
constexpr std::array<std::array<int, 2>, 4> kStep = {{{1, 0}, {0, -1}, {-1, 0}, {0, 1}}};
constexpr int turned(int direction, int lefts) {
    return (direction + lefts + 4) % 4;
}

// A corner of pixels, 0 to width and 0 to height.
struct Corner {
    int x, y;
    bool operator==(const Corner&) const = default;
};

// The first and the last edge of a line: where it begins or ends, and in which direction.
struct LineEnds {
    Corner begin;
    int first_direction;
    Corner end;
    int last_direction;
    bool closed;
};

class Tracer {
  public:
    Tracer(const LabelImage& labels, double tolerance)
        : labels_(labels), tolerance_(tolerance), corners_{labels.width + 1, labels.height + 1} {
        for (std::vector<bool>& seen : seen_) seen.resize(corners_.pixel_count(), false);
        outlines_.size = labels;
        outlines_.rings.resize(labels.count);
    }

    RegionOutlines run() {
        for_corners([&](const Corner& c) {
            if (!meeting(c)) return;
            for (int direction = 0; direction < 4; ++direction)
                if (is_edge(c, direction) && !seen(c, direction)) trace(c, direction);
        });
        for_corners([&](const Corner& c) {  // what meets no other line
            for (const int direction : {0, 3})
                if (is_edge(c, direction) && !seen(c, direction)) trace(c, direction);
        });
        join_rings();
        return std::move(outlines_);
    }

  private:
    template <typename Visit>
    void for_corners(const Visit& visit) const {
        for (int y = 0; y < corners_.height; ++y)
            for (int x = 0; x < corners_.width; ++x) visit(Corner{x, y});
    }

    Id label(int x, int y) const { return labels_.contains(x, y) ? labels_.at(x, y) : kNone; }
    // The region beside the edge from a corner, on the left and on the right.
    Id left(const Corner& c, int direction) const {
        constexpr std::array<std::array<int, 2>, 4> kPixel = {{{0, -1}, {-1, -1}, {-1, 0}, {0, 0}}};
        return label(c.x + kPixel[as_index(direction)][0], c.y + kPixel[as_index(direction)][1]);
    }
    Id right(const Corner& c, int direction) const { return left(c, turned(direction, -1)); }
    bool is_edge(const Corner& c, int direction) const { return left(c, direction) != right(c, direction); }

    // Whether lines end here: three or four meet, or it is a corner of the image.
    bool meeting(const Corner& c) const {
        int edges = 0;
        for (int direction = 0; direction < 4; ++direction) edges += is_edge(c, direction) ? 1 : 0;
        const bool frame_corner = (c.x == 0 || c.x == labels_.width) && (c.y == 0 || c.y == labels_.height);
        return edges > 2 || (frame_corner && edges > 0);
    }

    static Corner next(const Corner& c, int direction) {
        return {c.x + kStep[as_index(direction)][0], c.y + kStep[as_index(direction)][1]};
    }
    // An edge is marked at its upper or left end.
    std::vector<bool>::reference seen(const Corner& c, int direction) {
        const Corner at = direction == 1 || direction == 2 ? next(c, direction) : c;
        return seen_[as_index(direction % 2)][corners_.index(at.x, at.y)];
    }

    static std::size_t key(const GridSize& corners, const Corner& c, int direction) {
        return corners.index(c.x, c.y) * 4 + as_index(direction);
    }

    void trace(const Corner& begin, int direction) {
        const Id on_left = left(begin, direction), on_right = right(begin, direction);
        const bool closed = !meeting(begin);
        const int first_direction = direction;
        std::vector<Vec2d> line = {Vec2d(begin.x, begin.y)};
        Corner at = begin;
        for (;;) {
            seen(at, direction) = true;
            at = next(at, direction);
            line.emplace_back(at.x, at.y);
            if (meeting(at) || at == begin) break;
            const int from = direction;
            for (const int turn : {1, 0, -1})
                if (is_edge(at, turned(from, turn))) direction = turned(from, turn);
        }
        OutlineArc arc = smooth_line(line, closed, tolerance_);
        arc.left = on_left;
        arc.right = on_right;
        const std::size_t number = outlines_.arcs.size();
        outlines_.arcs.push_back(std::move(arc));
        ends_.push_back({begin, first_direction, at, direction, closed});
        if (closed) {
            if (on_left != kNone) outlines_.rings[on_left].push_back({{number, false}});
            if (on_right != kNone) outlines_.rings[on_right].push_back({{number, true}});
            return;
        }
        starts_[key(corners_, begin, first_direction)] = {number, false};
        starts_[key(corners_, at, turned(direction, 2))] = {number, true};
    }

    // Follows each region around itself. Where it meets itself in a corner it keeps to the left, so that
    // pixels that touch in a corner alone stay apart.
    void join_rings() {
        std::array<std::vector<bool>, 2> used;
        for (std::vector<bool>& u : used) u.resize(outlines_.arcs.size(), false);
        for (std::size_t first = 0; first < ends_.size(); ++first)
            for (const bool reversed : {false, true}) {
                const OutlineArc& arc = outlines_.arcs[first];
                const Id region = reversed ? arc.right : arc.left;
                if (region == kNone || ends_[first].closed || used[reversed][first]) continue;
                OutlineRing ring;
                for (DirectedArc now{first, reversed}; !used[now.reversed][now.arc];) {
                    used[now.reversed][now.arc] = true;
                    ring.push_back(now);
                    const LineEnds& ends = ends_[now.arc];
                    const Corner at = now.reversed ? ends.begin : ends.end;
                    const int heading = now.reversed ? turned(ends.first_direction, 2) : ends.last_direction;
                    for (const int turn : {1, 0, -1}) {
                        const int direction = turned(heading, turn);
                        if (!is_edge(at, direction) || left(at, direction) != region) continue;
                        now = starts_.at(key(corners_, at, direction));
                        break;
                    }
                }
                outlines_.rings[region].push_back(std::move(ring));
            }
    }

    const LabelImage& labels_;
    double tolerance_;
    GridSize corners_;
    std::array<std::vector<bool>, 2> seen_;  // edges to the right, edges down
    RegionOutlines outlines_;
    std::unordered_map<std::size_t, DirectedArc> starts_;  // by the first edge of an arc in its direction
    std::vector<LineEnds> ends_;                           // of each arc
};

}  // namespace

RegionOutlines region_outlines(const LabelImage& labels, double tolerance) {
    if (!(tolerance >= 0 && tolerance <= kMostOutlineTolerance))
        throw Error(ErrorKind::kBadArgument, cat("the tolerance of outlines is ", tolerance,
                                                 ", expected 0 to ", kMostOutlineTolerance));
    return Tracer(labels, tolerance).run();
}

}  // namespace imgmesh
