#include "formats/tileset/tile_side.h"

#include <algorithm>
#include <cmath>

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

// Whether the pixel is on a face, at the line. The strip of a lone pixel is beside it.
bool is_on_line(const TileSide& side, std::size_t pixel) {
    return pixel < side.pixels.size() && !side.pixels[pixel].off && side.pixels[pixel].weight[0] != 0;
}

// Returns the vertices of `side` that its neighbour must have.
std::vector<TileSide::Vertex> comparable(const TileSide& side, const TileSide& other) {
    if (!side.has_mask && !other.has_mask) return side.vertices;
    std::vector<TileSide::Vertex> out;
    for (const TileSide::Vertex& vertex : side.vertices) {
        const auto first = static_cast<std::size_t>(std::floor(vertex.at)),
                   last = static_cast<std::size_t>(std::ceil(vertex.at));
        if (is_on_line(side, first) && is_on_line(side, last) && is_on_line(other, first) &&
            is_on_line(other, last))
            out.push_back(vertex);
    }
    return out;
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
    const std::vector<TileSide::Vertex> of_a = comparable(a, b), of_b = comparable(b, a);
    if (of_a == of_b) return "";
    if (of_a.size() != of_b.size()) return cat(of_a.size(), " vertices and ", of_b.size());
    const auto [first, second] = std::ranges::mismatch(of_a, of_b);
    return first->at != second->at ? cat("a vertex at ", first->at, " and at ", second->at)
                                   : cat("two colours at ", first->at);
}

std::string pixel_difference(const TileSide& a, const TileSide& b) {
    if (a.pixels.size() != b.pixels.size()) return cat(a.pixels.size(), " pixels and ", b.pixels.size());
    const bool masked = a.has_mask || b.has_mask;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        if (masked && !(is_on_line(a, i) && is_on_line(b, i))) continue;
        if (a.pixels[i].off || b.pixels[i].off) return cat("pixel ", i, " does not lie on it");
        if (a.pixels[i] != b.pixels[i]) return cat("pixel ", i, " lies at two places");
    }
    return "";
}

}  // namespace imgmesh
