#include "libcore/pipeline/refine_level.h"

#include <algorithm>

#include "libcore/base/parallel.h"
#include "libcore/image/color.h"
#include "libcore/image/luv_encoder.h"
#include "libcore/optimize/optimize_mesh.h"
#include "libcore/refine/refine.h"

namespace imgmesh {
namespace {

FeatureImage encoded_image(const FeatureImage& luv) {
    FeatureImage out{luv.width, luv.height, 3, std::vector<float>(luv.data.size())};
    const LuvEncoder encoder(ColorSpace::kSrgb);
    parallel_blocks(0, luv.height, 16, [&](int first, int last) {
        std::vector<float> planes(static_cast<std::size_t>(luv.width) * 3);
        for (int y = first; y < last; ++y) {
            const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(luv.width);
            for (std::size_t x = 0; x < static_cast<std::size_t>(luv.width); ++x)
                for (std::size_t c = 0; c < 3; ++c)
                    planes[c * static_cast<std::size_t>(luv.width) + x] = luv.pixel(row + x)[c];
            encoder.encode_row(planes, luv.width, out.pixel(row), 3);
        }
    });
    return out;
}

template <class Convert>
void convert_colors(BaseMesh& mesh, Convert convert) {
    for (Id v = 0; v < mesh.vertex_count(); ++v) {
        const Vec3f color = convert(Vec3f(mesh.feature_of(v)));
        std::copy(color.data(), color.data() + 3, mesh.feature_of(v));
    }
}

// A strip one pixel wide has no rows to sum up. It needs no exchanges: all its vertices are on two lines, and
// relocations take them wherever exchanges would.
bool is_strip(const FeatureImage& image) {
    return image.width < 2 || image.height < 2;
}

void run_rounds(BaseMesh& mesh, const FeatureImage& image, const RefineParams& params,
                const Progress& progress, const Mask& mask) {
    if (params.exchange > 0 && !is_strip(image))
        optimize_mesh(mesh, image, params, progress, mask);
    else
        refine(mesh, image, params, progress, mask);
}

}  // namespace

void refine_level(BaseMesh& mesh, const FeatureImage& feature, const Mask& mask, Objective objective,
                  RefineParams params, const Progress& progress) {
    params.range = objective == Objective::kRgb ? ColorRange::kUnit : ColorRange::kLuv;
    if (objective == Objective::kLuv) return run_rounds(mesh, feature, params, progress, mask);
    convert_colors(mesh, [](const Vec3f& luv) { return encoded_from_luv(ColorSpace::kSrgb, luv); });
    run_rounds(mesh, encoded_image(feature), params, progress, mask);
    convert_colors(mesh, [](const Vec3f& encoded) {
        return luv_from_linear(linear_from_encoded(ColorSpace::kSrgb, encoded));
    });
}

}  // namespace imgmesh
