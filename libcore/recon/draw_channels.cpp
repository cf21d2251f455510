#include "libcore/recon/draw_channels.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "libcore/base/error.h"
#include "libcore/base/parallel.h"
#include "libcore/image/feature_space.h"
#include "libcore/mesh/bounded_raster.h"
#include "libcore/recon/level_colors.h"

namespace imgmesh {
namespace {

// Rows of one block: enough work to be worth handing over, few enough for every thread to get some.
constexpr int kGrainRows = 16;

// The origin of a channel of the result: a channel of the colour drawing, a feature of the mesh, or, without
// either, whether there is a face.
struct Origin {
    std::string name;
    int drawn = -1;
    int feature = -1;
};

std::vector<Origin> origins(const SplitNames& names, const Image& drawn, bool has_mask) {
    std::vector<Origin> out;
    // Grey is drawn as R = G = B.
    for (const std::string& name : names.color)
        out.push_back({name, drawn.channel(name == "Y" ? "G" : name), -1});
    const bool masked = names.color.empty() ? has_mask : drawn.channel("A") >= 0;
    if (masked && std::ranges::count(names.auxiliary, "A") == 0)
        out.push_back({"A", names.color.empty() ? -1 : drawn.channel("A"), -1});
    int feature = names.color.empty() ? 0 : 3;
    for (const std::string& name : names.auxiliary) out.push_back({name, -1, feature++});
    return out;
}

}  // namespace

Image draw_channels(const MeshImage& mesh_image, int level_index, const DrawParams& params) {
    if (params.mode != DrawMode::kMap && params.mode != DrawMode::kGouraud)
        throw Error(ErrorKind::kBadArgument, "only the map and Gouraud drawings have all channels");
    const SourceInfo& source = mesh_image.source;
    const SplitNames names = split_names(source.channel_names);
    const Level& level = checked_level(mesh_image, level_index);
    const BaseMesh& mesh = level.mesh;
    const double scale = checked_scale(source, params);
    Image drawn;
    if (!names.color.empty()) drawn = draw(mesh_image, level_index, params);
    PixelMap raster;
    if (params.mode == DrawMode::kGouraud)
        raster = bounded_raster(mesh, sample_grid(source.width, source.height, scale));
    const PixelMap& map = params.mode == DrawMode::kGouraud ? raster : level.map;

    const std::vector<Origin> from = origins(names, drawn, source.has_mask);
    Image out = make_image(map.width, map.height, as_int(from.size()));
    out.color_space = names.color.empty() ? ColorSpace::kLinear : drawn.color_space;
    out.sample_type = source.sample_type;
    for (std::size_t c = 0; c < from.size(); ++c) out.channel_names[c] = from[c].name;
    parallel_blocks(0, map.height, kGrainRows, [&](int first, int last) {
        for (int y = first; y < last; ++y)
            for (int x = 0; x < map.width; ++x) {
                const PixelCoord& coord = map.at(x, y);
                float* to = out.pixel(x, y);
                for (const Origin& origin : from) {
                    if (origin.drawn >= 0) {
                        *to++ = drawn.pixel(x, y)[origin.drawn];
                    } else if (coord.face == kNone) {
                        *to++ = 0;
                    } else if (origin.feature < 0) {
                        *to++ = 1;
                    } else {
                        const auto [a, b, c] = mesh.faces[coord.face];
                        *to++ = (1 - coord.u - coord.v) * mesh.feature_of(a)[origin.feature] +
                                coord.u * mesh.feature_of(b)[origin.feature] +
                                coord.v * mesh.feature_of(c)[origin.feature];
                    }
                }
            }
    });
    return out;
}

}  // namespace imgmesh
