#include "libcore/tiles/sides_of_tile.h"

#include <algorithm>

#include "libcore/base/index.h"
#include "libcore/pipeline/params.h"
#include "libcore/tiles/simplify_side.h"

namespace imgmesh {
namespace {

// A line of pixels as an image of one row.
Image line_of(const Image& image, const PixelRect& rect) {
    Image line{{rect.width() * rect.height(), 1, image.channels, {}},
               image.channel_names,
               image.sample_type,
               image.color_space};
    for (int y = rect.top; y < rect.bottom; ++y)
        for (int x = rect.left; x < rect.right; ++x)
            line.data.insert(line.data.end(), image.pixel(x, y), image.pixel(x, y) + image.channels);
    return line;
}

// Returns which pixels of the line are inside.
std::vector<bool> inside_of(const Mask& mask, const PixelRect& rect) {
    std::vector<bool> inside;
    for (int y = rect.top; y < rect.bottom; ++y)
        for (int x = rect.left; x < rect.right; ++x) inside.push_back(mask.empty() || mask.at(x, y));
    return inside;
}

Side cut_side(const FeatureImage& line, const std::vector<bool>& inside) {
    Side side;
    for (std::size_t i = 0; i < inside.size(); ++i) {
        if (!inside[i]) continue;
        side.vertices.push_back(as_int(i));
        side.features.insert(side.features.end(), line.pixel(i), line.pixel(i) + line.channels);
    }
    return side;
}

}  // namespace

TileSides sides_of_tile(const Image& image, const BuildParams& params, const TileCommon& common,
                        const TileMask& mask) {
    const FitParams fit = fit_params(params, common.space);
    const SideParams own{.threshold = common.max_increment.value_or(params.stop.error.value_or(0)),
                         .smoothness = fit.color_weight > 0 ? 1 / fit.color_weight : 0,
                         .gouraud_share = fit.gouraud_share};
    const auto side_of = [&](const PixelRect& rect, bool cut) {
        const FeatureImage line = tile_features(line_of(image, rect), common);
        Side side =
            cut ? cut_side(line, inside_of(mask.mask, rect)) : simplify_side(line.data, line.channels, own);
        round_tile_features(side.features, params, common);
        return side;
    };
    const int w = image.width, h = image.height;
    return {side_of({0, 0, w, 1}, mask.cut.top), side_of({0, h - 1, w, h}, mask.cut.bottom),
            side_of({0, 0, 1, h}, mask.cut.left), side_of({w - 1, 0, w, h}, mask.cut.right)};
}

}  // namespace imgmesh
