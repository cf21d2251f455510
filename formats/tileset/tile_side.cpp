#include "formats/tileset/tile_side.h"

#include <algorithm>

#include "libcore/base/error.h"

namespace imgmesh {
namespace {

// A line of the picture: the axis across it, and where it crosses that.
struct Line {
    int axis;
    float place;
    bool holds(const Vec2f& p) const { return p[axis] == place; }
    float along(const Vec2f& p) const { return p[1 - axis]; }
};

TileSide::Pixel pixel_on(const Line& line, const BaseMesh& mesh, const PixelCoord& c) {
    TileSide::Pixel pixel;
    if (c.face == kNone) return pixel;
    const std::array<float, 3> weights = {1 - c.u - c.v, c.u, c.v};
    std::size_t used = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        if (weights[i] == 0) continue;
        const Vec2f& p = mesh.position[mesh.faces[c.face][i]];
        if (!line.holds(p) || used == 2) {
            pixel.off = true;
            return pixel;
        }
        pixel.at[used] = line.along(p);
        pixel.weight[used++] = weights[i];
    }
    if (used == 2 && pixel.at[0] > pixel.at[1]) {
        std::swap(pixel.at[0], pixel.at[1]);
        std::swap(pixel.weight[0], pixel.weight[1]);
    }
    return pixel;
}

}  // namespace

TileSide tile_side(const MeshImage& image, SideOf side) {
    const SourceInfo& size = image.source;
    const BaseMesh& mesh = image.levels[0].mesh;
    const bool column = side == SideOf::kLeft || side == SideOf::kRight;
    const int last = (column ? size.width : size.height) - 1;
    const int place = side == SideOf::kLeft || side == SideOf::kTop ? 0 : last;
    const Line line{column ? 0 : 1, static_cast<float>(place)};
    TileSide out;
    out.has_mask = size.has_mask;
    for (Id v = 0; v < mesh.vertex_count(); ++v)
        if (line.holds(mesh.position[v]))
            out.vertices.push_back(
                {line.along(mesh.position[v]), {mesh.feature_of(v), mesh.feature_of(v) + mesh.channels}});
    std::ranges::sort(out.vertices, [](const TileSide::Vertex& a, const TileSide::Vertex& b) {
        return a.at != b.at ? a.at < b.at : a.features < b.features;
    });
    // Draco splits vertices at which a mask's outline meets itself.
    out.vertices.erase(std::unique(out.vertices.begin(), out.vertices.end()), out.vertices.end());
    for (int i = 0; i < (column ? size.height : size.width); ++i) {
        const std::size_t pixel = column ? size.index(place, i) : size.index(i, place);
        out.pixels.push_back(pixel_on(line, mesh, image.levels[0].map[pixel]));
    }
    return out;
}

std::string vertex_difference(const TileSide& a, const TileSide& b) {
    if (a.vertices == b.vertices) return "";
    if (a.vertices.size() != b.vertices.size())
        return cat(a.vertices.size(), " vertices and ", b.vertices.size());
    const auto [first, second] = std::ranges::mismatch(a.vertices, b.vertices);
    return first->at != second->at ? cat("a vertex at ", first->at, " and at ", second->at)
                                   : cat("two colours at ", first->at);
}

std::string pixel_difference(const TileSide& a, const TileSide& b) {
    if (a.pixels.size() != b.pixels.size()) return cat(a.pixels.size(), " pixels and ", b.pixels.size());
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        if (a.pixels[i].off || b.pixels[i].off) return cat("pixel ", i, " does not lie on it");
        if (a.pixels[i] != b.pixels[i]) return cat("pixel ", i, " lies at two places");
    }
    return "";
}

}  // namespace imgmesh
