#include "libcore/mesh/loop_parts.h"

#include "libcore/base/error.h"

namespace imgmesh {
namespace {

// Positive for an outer loop.
double area2(const Loop& loop) {
    double sum = 0;
    for (std::size_t i = 0; i + 2 < loop.size(); ++i) {
        const Vec2d a = loop[i + 1] - loop[0], b = loop[i + 2] - loop[0];
        sum += a.y() * b.x() - a.x() * b.y();
    }
    return sum;
}

// A point just inside the material beside the hole's first edge decides, as corners may be shared.
bool contains(const Loop& loop, const Loop& hole) {
    const Vec2d along = (hole[1] - hole[0]).normalized(),
                p = (hole[0] + hole[1]) / 2 + 1e-3 * Vec2d(along.y(), -along.x());
    bool in = false;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Vec2d &from = loop[i], &to = loop[(i + 1) % loop.size()];
        if ((from.y() > p.y()) != (to.y() > p.y()) &&
            p.x() < from.x() + (p.y() - from.y()) * (to.x() - from.x()) / (to.y() - from.y()))
            in = !in;
    }
    return in;
}

}  // namespace

std::vector<std::vector<std::size_t>> loop_parts(const std::vector<Loop>& loops) {
    std::vector<std::vector<std::size_t>> parts;
    std::vector<double> area;  // of each part's outer loop
    std::vector<std::size_t> holes;
    for (std::size_t i = 0; i < loops.size(); ++i) {
        const double twice = area2(loops[i]);
        if (twice > 0) {
            parts.push_back({i});
            area.push_back(twice);
        } else {
            holes.push_back(i);
        }
    }
    for (const std::size_t hole : holes) {
        std::size_t smallest = parts.size();
        for (std::size_t p = 0; p < parts.size(); ++p)
            if ((smallest == parts.size() || area[p] < area[smallest]) &&
                contains(loops[parts[p][0]], loops[hole]))
                smallest = p;
        if (smallest == parts.size()) throw Error(ErrorKind::kInternal, "a hole lies in no outline");
        parts[smallest].push_back(hole);
    }
    return parts;
}

}  // namespace imgmesh
