#include "libcore/param/fit_map.h"

#include "libcore/base/error.h"
#include "libcore/image/color.h"
#include "libcore/param/fit_colors.h"
#include "libcore/param/relax.h"
#include "libcore/param/storable_map.h"
#include "libcore/param/trivial_map.h"

namespace imgmesh {
namespace {

// Where pixels lie, as a map whose weights are not yet rounded: what the colours are fitted to between the
// rounds.
PixelMap unrounded_map(const MovingPixels& pixels, const std::vector<FaceField>& fields) {
    PixelMap map{pixels.width, pixels.height, std::vector<PixelCoord>(pixels.face.size()),
                 WeightPrecision::kFloat};
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
            const Vec2f p = pixels.image_of(x, y);
            const Id face = pixels.face[pixels.index(x, y)];
            if (face == kNone) continue;
            map.coords[pixels.index(x, y)] = {face, fields[face].u(p.x(), p.y()),
                                              fields[face].v(p.x(), p.y())};
        }
    return map;
}

PixelMap stored(const BaseMesh& mesh, const MovingPixels& pixels, const std::vector<FaceField>& fields,
                const std::vector<Face>& neighbors, std::optional<WeightPrecision> wanted) {
    for (const WeightPrecision precision : {WeightPrecision::kHalf, WeightPrecision::kFloat})
        if (!wanted || *wanted == precision)
            if (auto map = storable_map(mesh, pixels, fields, neighbors, precision)) return *std::move(map);
    throw Error(ErrorCode::kUnsupported,
                "the weights are too coarse for faces this large: --bary float holds them");
}

void round_colors(BaseMesh& mesh, const FeatureSpace& space) {
    const float weight = space.color_weight;
    for (Id v = 0; v < mesh.vertex_count(); ++v) {
        const Eigen::Map<Vec3f> color(mesh.feature_of(v));
        const Vec3f storable = weight * storable_color(color / weight, space.gamut);
        std::copy(storable.data(), storable.data() + 3, mesh.feature_of(v));
    }
}

}  // namespace

PixelMap fit_map(BaseMesh& mesh, const FeatureImage& feature, const FitParams& params,
                 const Progress& progress, const Mask& mask) {
    const PixelMap trivial = trivial_map(mesh, feature.width, feature.height, mask);
    const auto fit = [&](const PixelMap& map) {
        if (params.keep_colors) return;
        fit_colors(mesh, feature, {{&map, 1 - params.gouraud_share}, {&trivial, params.gouraud_share}},
                   params.space);
    };
    const std::vector<Face> neighbors = face_neighbors(mesh);
    MovingPixels pixels = resting_pixels(trivial, mask);
    fit(trivial);
    // A strip of one pixel has no cell whose fold could be watched; its map stays trivial.
    const int rounds = params.color_weight > 0 && feature.width > 1 && feature.height > 1 ? params.rounds : 0;
    for (int round = 0; round < rounds; ++round) {
        if (progress) progress(static_cast<double>(round) / params.rounds, "map");
        const std::vector<FaceField> fields = face_fields(mesh);
        relax(pixels, fields, neighbors, feature, static_cast<float>(1 / params.color_weight), params.sweeps,
              further_fields(mesh, fields));
        if (round + 1 < rounds) fit(unrounded_map(pixels, fields));
    }
    PixelMap map = stored(mesh, pixels, face_fields(mesh), neighbors, params.bary);
    fit(map);
    if (params.space.color) round_colors(mesh, params.space);
    return map;
}

}  // namespace imgmesh
