#include "libcore/pipeline/level_colors.h"

#include <algorithm>
#include <limits>

#include "libcore/image/color.h"

namespace imgmesh {

void take_weights_out(BaseMesh& mesh, const FeatureSpace& space) {
    for (Id v = 0; v < mesh.vertex_count(); ++v) {
        float* f = mesh.feature_of(v);
        for (int c = 0; c < space.features(); ++c) f[c] = f[c] / space.weight(c) + space.offset(c);
        if (!space.color || space.color_weight == 1) continue;
        const Vec3f color = quantized_color(Vec3f(f), space.gamut);
        std::copy(color.data(), color.data() + 3, f);
    }
}

void limit_alpha(BaseMesh& mesh, const FeatureImage& feature, const FeatureSpace& space, const Mask& mask) {
    const auto at = std::ranges::find(space.auxiliary, "A");
    if (at == space.auxiliary.end()) return;
    const auto c = (space.color ? 3 : 0) + (at - space.auxiliary.begin());
    float least = std::numeric_limits<float>::max(), most = std::numeric_limits<float>::lowest();
    for (std::size_t i = 0; i < feature.pixel_count(); ++i) {
        if (!mask.contains(i)) continue;
        least = std::min(least, feature.pixel(i)[c]);
        most = std::max(most, feature.pixel(i)[c]);
    }
    for (Id v = 0; v < mesh.vertex_count(); ++v)
        mesh.feature_of(v)[c] = std::clamp(mesh.feature_of(v)[c], least, most);
}

}  // namespace imgmesh
