#include "libcore/tiles/join_tiles.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "libcore/base/index.h"
#include "libcore/mesh/tile_sides.h"
#include "libcore/simplify/simplify_mesh.h"
#include "libcore/tiles/settle_positions.h"
#include "libcore/tiles/simplify_side.h"
#include "libcore/tiles/tile_joiner.h"

namespace imgmesh {
namespace {

// A side of the parent: which coordinate is fixed, where, and the length along it.
struct Line {
    int axis;  // the fixed coordinate: 0 for x, 1 for y
    float at;
};

// Returns the vertices of a mesh on a line, along it.
std::vector<Id> vertices_on(const BaseMesh& mesh, const Line& line) {
    std::vector<Id> found;
    for (Id v = 0; v < mesh.vertex_count(); ++v)
        if (mesh.position[v][line.axis] == line.at) found.push_back(v);
    const int along = 1 - line.axis;
    std::ranges::sort(found, {}, [&](Id v) { return std::pair(mesh.position[v][along], v); });
    return found;
}

bool is_pixel(float place) {
    return place == std::round(place);
}

// The side with all of its vertices. Those between pixels are corners of a mask's strips, and where an
// outline meets itself there are several at one pixel.
Side side_of(const BaseMesh& mesh, std::span<const Id> vertices, int along) {
    Side side;
    for (const Id v : vertices) {
        const float place = mesh.position[v][along];
        const auto pixel = static_cast<int>(std::lround(place));
        if (!is_pixel(place) || (!side.vertices.empty() && side.vertices.back() == pixel)) continue;
        side.vertices.push_back(pixel);
        side.features.insert(side.features.end(), mesh.feature_of(v), mesh.feature_of(v) + mesh.channels);
    }
    return side;
}

Vec2f point(int x, int y) {
    return {static_cast<float>(x), static_cast<float>(y)};
}

using Place = std::pair<float, float>;
Place place_of(const Vec2f& place) {
    return {place.x(), place.y()};
}

// The collapse has mixed the colours of sides with what lies beside them, and the neighbour would mix others.
void set_features(BaseMesh& mesh, const std::map<Place, const float*>& features) {
    for (Id v = 0; v < mesh.vertex_count(); ++v)
        if (const auto at = features.find(place_of(mesh.position[v])); at != features.end())
            std::copy_n(at->second, mesh.channels, mesh.feature_of(v));
}

void scale(BaseMesh& mesh, float factor) {
    for (Vec2f& place : mesh.position) place *= factor;
}

}  // namespace

BaseMesh joined_children(std::span<const ChildTile> children) {
    TileJoiner joiner;
    for (const ChildTile& child : children) {
        const Vec2f far = point(child.width - 1, child.height - 1);
        BaseMesh mesh = child.mesh;
        for (Vec2f& place : mesh.position) place = place.cwiseMax(Vec2f(0, 0)).cwiseMin(far);
        joiner.add(mesh, point(child.left, child.top), far);
    }
    return joiner.take();
}

BaseMesh coarser_tile(std::span<const ChildTile> children, int level, int width, int height,
                      const SimplifyParams& params) {
    const BaseMesh joined = joined_children(children);
    const auto right = static_cast<float>(width - 1), bottom = static_cast<float>(height - 1);
    std::vector<Id> kept;
    for (const Line& line : {Line{1, 0}, Line{1, bottom}, Line{0, 0}, Line{0, right}}) {
        const int along = 1 - line.axis;
        const std::vector<Id> vertices = vertices_on(joined, line);
        const Side whole = side_of(joined, vertices, along);
        const Side half = whole.vertices.size() < 3 ? whole : coarser_side(whole, joined.channels);
        for (const Id v : vertices) {
            const float place = joined.position[v][along];
            if (!is_pixel(place) || std::binary_search(half.vertices.begin(), half.vertices.end(),
                                                       static_cast<int>(std::lround(place))))
                kept.push_back(v);
        }
    }
    std::ranges::sort(kept);
    kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
    std::map<Place, const float*> on_sides;
    for (const Id v : kept) on_sides.emplace(place_of(joined.position[v]), joined.feature_of(v));
    // Levels look alike at their own scale. A power of two loses nothing.
    const float unit = std::ldexp(1.0f, -level);
    BaseMesh mesh = joined;
    scale(mesh, unit);
    const auto goal = static_cast<std::int64_t>(mesh.vertex_count() / 4);
    // Meshes have quadrics of one kind alone.
    SimplifyParams own = params;
    own.metric = SimplifyParams().metric;
    own.solver = SimplifyParams().solver;
    SimplifyResult coarse = simplify_mesh(mesh, unit * Vec2f(right, bottom), kept, own,
                                          {.vertices = std::max<std::int64_t>(4, goal)});
    settle_positions(coarse.mesh);
    scale(coarse.mesh, 1 / unit);
    set_features(coarse.mesh, on_sides);
    return std::move(coarse.mesh);
}

}  // namespace imgmesh
