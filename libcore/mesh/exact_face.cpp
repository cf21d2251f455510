#include "libcore/mesh/exact_face.h"

#include <algorithm>
#include <cmath>

#include "libcore/base/error.h"
#include "libcore/base/parallel.h"

namespace imgmesh {
namespace {

// Below it, in either direction [pixels].
constexpr float kMostPixels = 131072;
// Makes the sum of three coordinates positive [units].
constexpr std::int64_t kPositive = 3 * static_cast<std::int64_t>(kMostPixels) * kPixelUnits;

constexpr int kGrainFaces = 4096;

std::vector<GridPoint> grid_points(const std::vector<Vec2f>& position) {
    std::vector<GridPoint> points(position.size());
    const auto units = [](float pixels) {
        const float all = pixels * kPixelUnits;
        if (!(std::abs(pixels) < kMostPixels) || all != std::floor(all))
            throw Error(ErrorKind::kUnsupported,
                        cat("a vertex lies at ", pixels, ", expected a multiple of 1/", kPixelUnits,
                            " pixel below ", kMostPixels));
        return static_cast<std::int32_t>(all);
    };
    for (std::size_t v = 0; v < points.size(); ++v)
        points[v] = {units(position[v].x()), units(position[v].y())};
    return points;
}

ExactFace exact_face(const std::array<GridPoint, 3>& corner) {
    const auto& [a, b, c] = corner;
    ExactFace face{};
    face.a = a;
    face.bx = a.y - c.y;
    face.by = c.x - a.x;
    face.cx = b.y - a.y;
    face.cy = a.x - b.x;
    face.area =
        std::max<std::int64_t>(0, std::int64_t{face.bx} * (b.x - a.x) + std::int64_t{face.by} * (b.y - a.y));
    face.inverse_area = face.area > 0 ? 1 / static_cast<double>(face.area) : 0;
    face.order =
        (std::int64_t{a.y} + b.y + c.y + kPositive) << 32 | (std::int64_t{a.x} + b.x + c.x + kPositive);
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t other = 0; other < 3; ++other)
            face.precedence[k] +=
                std::pair(corner[k].y, corner[k].x) < std::pair(corner[other].y, corner[other].x);
    return face;
}

}  // namespace

std::vector<ExactFace> exact_faces(const BaseMesh& mesh) {
    const std::vector<GridPoint> point = grid_points(mesh.position);
    std::vector<ExactFace> faces(mesh.faces.size());
    parallel_blocks(0, as_int(faces.size()), kGrainFaces, [&](int first, int last) {
        for (std::size_t f = as_index(first); f < as_index(last); ++f) {
            const auto [a, b, c] = mesh.faces[f];
            faces[f] = exact_face({point[a], point[b], point[c]});
        }
    });
    return faces;
}

}  // namespace imgmesh
