#include "formats/export/mesh_arrays.h"

#include <algorithm>

#include "formats/export/npy.h"
#include "libcore/image/color.h"
#include "libcore/image/feature_space.h"

namespace imgmesh {
namespace {

// Texts of one length, filled up with zeros.
struct Texts {
    std::size_t longest = 1;
    std::vector<std::uint8_t> bytes;

    explicit Texts(const std::vector<std::string>& all) {
        for (const std::string& text : all) longest = std::max(longest, text.size());
        for (std::string text : all) {
            text.resize(longest);
            bytes.insert(bytes.end(), text.begin(), text.end());
        }
    }
};

}  // namespace

std::vector<float> vertex_colors(const BaseMesh& mesh, const SourceInfo& source) {
    std::vector<float> rgb;
    if (split_names(source.channel_names).color.empty()) return rgb;
    rgb.reserve(mesh.vertex_count() * 3);
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
        const Vec3f luv(mesh.feature_of(as_id(v)));
        const Vec3f linear = linear_from_luv(in_gamut(luv, source.gamut));
        const Vec3f color =
            source.gamut == Gamut::kHdr ? linear : encoded_from_linear(ColorSpace::kSrgb, linear);
        rgb.insert(rgb.end(), color.data(), color.data() + 3);
    }
    return rgb;
}

void write_mesh_arrays(const std::string& path, const MeshImage& mesh_image, std::size_t level,
                       bool overwrite) {
    const BaseMesh& mesh = mesh_image.levels[level].mesh;
    const PixelMap& map = mesh_image.levels[level].map;
    const auto width = as_index(map.width), height = as_index(map.height), vertices = mesh.vertex_count();
    std::vector<Id> ids;
    std::vector<float> weights;
    ids.reserve(map.size());
    weights.reserve(2 * map.size());
    for (const PixelCoord& pixel : map) {
        ids.push_back(pixel.face);
        weights.push_back(pixel.u);
        weights.push_back(pixel.v);
    }
    const std::vector<float> colors = vertex_colors(mesh, mesh_image.source);
    const Texts names(mesh_image.source.channel_names);
    std::vector<NumpyArray> arrays = {
        {"vertices", "f4", {vertices, 2}, bytes_of(mesh.position)},
        {"faces", "u4", {mesh.faces.size(), 3}, bytes_of(mesh.faces)},
        {"features", "f4", {vertices, as_index(mesh.channels)}, bytes_of(mesh.feature)},
        {"face_ids", "u4", {height, width}, bytes_of(ids)},
        {"barycentrics", "f4", {height, width, 2}, bytes_of(weights)},
        {"channel_names",
         "S" + std::to_string(names.longest),
         {mesh_image.source.channel_names.size()},
         names.bytes}};
    if (!colors.empty()) arrays.push_back({"colors", "f4", {vertices, 3}, bytes_of(colors)});
    if (level == 0 && !mesh_image.visits.empty())
        arrays.push_back({"visits", "u4", {height, width}, bytes_of(mesh_image.visits)});
    write_npz(path, arrays, overwrite);
}

}  // namespace imgmesh
