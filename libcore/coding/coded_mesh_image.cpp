#include "libcore/coding/coded_mesh_image.h"

#include <algorithm>

#include "libcore/image/color.h"
#include "libcore/mesh/trivial_map.h"

namespace imgmesh::coding {
namespace {

using Vec4f = Eigen::Vector4f;

constexpr float kQuarters = 4;  // of a pixel
constexpr float kWhite = 255 * kColorUnit;
constexpr float kSureAlpha = 4.0f / 255;  // below it a colour divided by alpha is mostly its coding's error

// A side of one pixel lies between -0.5 and 0.5, as build_mesh_image() has it.
float place(int quarters, int side) {
    return static_cast<float>(quarters) / kQuarters - (side == 1 ? 0.5f : 0.0f);
}

// Returns sRGB and alpha of a vertex.
Vec4f straight_color(const std::int32_t* color, int channels) {
    const bool has_alpha = channels == 2 || channels == 4;
    Vec4f out = Vec4f::Zero();
    out[3] = has_alpha ? std::clamp(static_cast<float>(color[channels - 1]) / kWhite, 0.0f, 1.0f) : 1.0f;
    for (int k = 0; k < 3; ++k) {
        const float sample = static_cast<float>(color[channels < 3 ? 0 : k]) / kWhite;
        if (out[3] > 0) out[k] = std::clamp(sample / out[3], 0.0f, 1.0f);
    }
    return out;
}

// Returns a colour times its weight, and the weight.
Vec4f weighted(const Vec4f& color, float weight) {
    return weight * Vec4f(color[0], color[1], color[2], 1);
}

// Gives vertices that are hardly seen the mean of their own and their neighbours' colours, each counted as
// far as it is seen, and so on inwards. Where programs mix colours and alpha apart, the black of nothing
// would be a dark seam.
void fill_unseen(const BaseMesh& mesh, std::vector<Vec4f>& color) {
    std::vector<char> known(color.size());
    for (std::size_t v = 0; v < color.size(); ++v) known[v] = color[v][3] >= kSureAlpha;
    std::vector<std::vector<Id>> neighbors(color.size());  // of the others
    std::vector<Id> front, next;
    for (const auto& [a, b] : mesh_edges(mesh)) {
        if (!known[a]) neighbors[a].push_back(b);
        if (!known[b]) neighbors[b].push_back(a);
        if (known[a] != known[b]) next.push_back(known[a] ? b : a);
    }
    while (!next.empty()) {
        std::ranges::sort(next);
        next.erase(std::unique(next.begin(), next.end()), next.end());
        front.swap(next);
        next.clear();
        for (const Id v : front) {
            Vec4f sum = weighted(color[v], color[v][3]);
            for (const Id n : neighbors[v])
                if (known[n]) sum += weighted(color[n], std::max(color[n][3], kSureAlpha));
            color[v].head<3>() = sum.head<3>() / sum[3];
        }
        for (const Id v : front) known[v] = true;
        for (const Id v : front)
            for (const Id n : neighbors[v])
                if (!known[n]) next.push_back(n);
    }
}

// Returns L*u*v*, and alpha if there is one, of each vertex.
std::vector<float> features(const std::vector<Vec4f>& color, bool has_alpha) {
    std::vector<float> out;
    for (const Vec4f& c : color) {
        const Vec3f srgb = c.head<3>();
        const Vec3f luv = quantized_color(luv_from_linear(linear_from_encoded(ColorSpace::kSrgb, srgb)));
        out.insert(out.end(), luv.begin(), luv.end());
        if (has_alpha) out.push_back(c[3]);
    }
    return out;
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
    std::vector<Vec4f> color;
    for (std::size_t v = 0; v < content.point.size(); ++v) {
        const auto [column, row] = content.point[v];
        level.mesh.position.emplace_back(place(grid.x(column), grid.width), place(grid.y(row), grid.height));
        color.push_back(
            straight_color(&content.color[v * static_cast<std::size_t>(content.channels)], content.channels));
    }
    level.mesh.faces = content.faces;
    if (has_alpha) fill_unseen(level.mesh, color);
    level.mesh.feature = features(color, has_alpha);
    level.map = trivial_map(level.mesh, grid.width, grid.height);
    out.levels.push_back(std::move(level));
    return out;
}

}  // namespace imgmesh::coding
