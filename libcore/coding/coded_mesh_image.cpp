#include "libcore/coding/coded_mesh_image.h"

#include <algorithm>

#include "libcore/image/color.h"
#include "libcore/mesh/trivial_map.h"

namespace imgmesh::coding {
namespace {

constexpr float kQuarters = 4;  // of a pixel
constexpr float kWhite = 255 * kColorUnit;

// A side of one pixel lies between -0.5 and 0.5, as build_mesh_image() has it.
float place(int quarters, int side) {
    return static_cast<float>(quarters) / kQuarters - (side == 1 ? 0.5f : 0.0f);
}

// Appends L*u*v*, and alpha if there is one, of a vertex.
void append_feature(const std::int32_t* color, int channels, std::vector<float>& feature) {
    const bool has_alpha = channels == 2 || channels == 4;
    const float alpha =
        has_alpha ? std::clamp(static_cast<float>(color[channels - 1]) / kWhite, 0.0f, 1.0f) : 1.0f;
    Vec3f srgb;
    for (int k = 0; k < 3; ++k) {
        const float sample = static_cast<float>(color[channels < 3 ? 0 : k]) / kWhite;
        srgb[k] = alpha > 0 ? std::clamp(sample / alpha, 0.0f, 1.0f) : 0.0f;
    }
    const Vec3f luv = quantized_color(luv_from_linear(linear_from_encoded(ColorSpace::kSrgb, srgb)));
    feature.insert(feature.end(), luv.begin(), luv.end());
    if (has_alpha) feature.push_back(alpha);
}

}  // namespace

MeshImage mesh_image_from_coded(const StreamContent& content) {
    const CodedGrid& grid = content.grid;
    const bool has_alpha = content.channels == 2 || content.channels == 4;
    MeshImage out;
    out.source.width = grid.width;
    out.source.height = grid.height;
    out.source.channel_names = make_image(1, 1, content.channels).channel_names;
    Level level;
    level.mesh.channels = has_alpha ? 4 : 3;
    for (std::size_t v = 0; v < content.point.size(); ++v) {
        const auto [column, row] = content.point[v];
        level.mesh.position.emplace_back(place(grid.x(column), grid.width), place(grid.y(row), grid.height));
        append_feature(&content.color[v * static_cast<std::size_t>(content.channels)], content.channels,
                       level.mesh.feature);
    }
    level.mesh.faces = content.faces;
    level.map = trivial_map(level.mesh, grid.width, grid.height);
    out.levels.push_back(std::move(level));
    return out;
}

}  // namespace imgmesh::coding
