// What refinement and the optimiser have in common: where they start, and what holds of what they make.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "libcore/base/parallel.h"
#include "libcore/mesh/tile_sides.h"
#include "libcore/mesh/trivial_map.h"
#include "libcore/metrics/metrics.h"
#include "libcore/pipeline/build.h"
#include "libcore/refine/refine_params.h"
#include "libcore/simplify/simplify.h"
#include "tests/support/sample_masks.h"
#include "tests/support/sample_pictures.h"
#include "tests/support/simplify_params.h"

namespace imgmesh::test {

inline BaseMesh collapsed(const FeatureImage& feature, std::int64_t vertices, float min_shape = 0) {
    SimplifyParams params = plain_params();
    params.min_shape = min_shape;
    SimplifyTarget target;
    target.vertices = vertices;
    return simplify(grid_mesh(feature), params, target).mesh;
}

/// Squared error of the mesh as it is drawn: from the rasteriser, pixel by pixel, and with none of the sums
/// that are tested.
inline double drawn_error(const BaseMesh& mesh, const FeatureImage& feature) {
    const double rms = map_rms(mesh, trivial_map(mesh, feature.width, feature.height), feature);
    return rms * rms * static_cast<double>(feature.pixel_count());
}

inline void check_sound(const BaseMesh& mesh, std::size_t vertices, int width, int height) {
    const MeshQuality q = mesh_quality(mesh);
    CHECK(mesh.vertex_count() == vertices);
    CHECK(q.euler == 1);
    CHECK(q.flipped_faces + q.nonmanifold_edges + q.nonmanifold_vertices == 0);
    CHECK(q.area == double(std::max(1, width - 1)) * std::max(1, height - 1));
    for (const Vec2f& p : mesh.position) CHECK(p == Vec2f(snapped(p.x()), snapped(p.y())));
    for (const float f : mesh.feature) CHECK(std::isfinite(f));
}

/// improve(mesh, feature, params) refines. Limits on shape and area hold, and shape weighs against error.
template <class Improve>
void check_limits(const RefineParams& without_limits, const Improve& improve) {
    const FeatureImage feature = sample_feature(Kind::kDisc, 80, 60);
    const BaseMesh start = collapsed(feature, 150, 0.4f);
    RefineParams params = without_limits;
    const auto improved = [&] {
        BaseMesh mesh = start;
        improve(mesh, feature, params);
        return mesh;
    };
    const BaseMesh free = improved();
    params.min_quality = 0.4;
    CHECK(mesh_quality(improved()).min_shape >= 0.4);
    CHECK(mesh_quality(free).min_shape < 0.4);
    params.min_quality = 0;
    params.shape_weight = 1;
    CHECK(mesh_quality(improved()).mean_shape > mesh_quality(free).mean_shape + 0.05);
    params.shape_weight = 0;
    const auto largest = [](const BaseMesh& mesh) {
        double area = 0;
        for (const auto& [a, b, c] : mesh.faces)
            area = std::max(area, signed_area2(mesh.position[a], mesh.position[b], mesh.position[c]) / 2);
        return area;
    };
    params.max_face_area = largest(start);
    CHECK(largest(free) > params.max_face_area);
    CHECK(largest(improved()) <= params.max_face_area);
}

/// improve(mesh) gives the same bytes for any number of threads.
template <class Improve>
BaseMesh check_threads(const BaseMesh& start, const Improve& improve) {
    BaseMesh first = start, second = start;
    improve(first);
    const ThreadLimit one(1);
    improve(second);
    CHECK(first.position == second.position);
    CHECK(first.feature == second.feature);
    CHECK(first.faces == second.faces);
    return first;
}

/// The vertices on the sides of an image with their colours, in the order of their places.
inline std::vector<std::array<float, 5>> side_of(const BaseMesh& mesh, const GridSize& image) {
    std::vector<std::array<float, 5>> out;
    for (Id v = 0; v < mesh.vertex_count(); ++v) {
        const Vec2f& p = mesh.position[v];
        const float* f = mesh.feature_of(v);
        if (on_side(p, image.width, image.height)) out.push_back({p.x(), p.y(), f[0], f[1], f[2]});
    }
    std::sort(out.begin(), out.end());
    return out;
}

/// improve(mesh, feature, params) refines. With keep_sides it leaves what is on the sides as it is, and so
/// many vertices and faces; without, it does not.
template <class Improve>
void check_sides(const RefineParams& any_sides, const Improve& improve) {
    for (const Kind kind : {Kind::kGradient, Kind::kNoise, Kind::kDisc})
        for (const auto& [w, h] : {std::pair{60, 45}, {130, 20}, {9, 2}, {3, 3}}) {
            INFO(name_of(kind) << " " << w << " x " << h);
            FeatureImage feature = sample_feature(kind, w, h);
            if (any_sides.range == ColorRange::kUnit)
                for (float& f : feature.data) f = std::abs(f) / 200;
            const BaseMesh start = collapsed(feature, std::max(4, w * h / 30));
            RefineParams params = any_sides;
            params.keep_sides = true;
            BaseMesh mesh = start, free = start;
            improve(mesh, feature, params);
            CHECK((side_of(mesh, feature) == side_of(start, feature)));
            CHECK(mesh.faces.size() == start.faces.size());
            check_sound(mesh, start.vertex_count(), w, h);
            CHECK(drawn_error(mesh, feature) <= drawn_error(start, feature) * 1.001);
            params.keep_sides = false;
            improve(free, feature, params);
            CHECK_FALSE((side_of(free, feature) == side_of(start, feature)));
        }
}

/// In masked images pixels outside do not count, the boundary stays, and the map stays one to one. `plain`
/// and `refined` build without and with what is tested.
inline void check_masks(const BuildParams& plain, const BuildParams& refined) {
    for (const auto& [name, mask] : sample_masks(40)) {
        INFO(name);
        Image image = sample_picture(Kind::kNoise, mask.width, mask.height);
        const BuildResult start = build_mesh_image(image, plain, {}, mask);
        const Level level = build_mesh_image(image, refined, {}, mask).mesh_image.levels[0];
        const MeshQuality before = mesh_quality(start.mesh_image.levels[0].mesh),
                          after = mesh_quality(level.mesh);
        CHECK(after.vertices == before.vertices);
        CHECK(after.euler == before.euler);
        CHECK(after.components == before.components);
        CHECK(after.area == before.area);
        CHECK(after.flipped_faces + after.nonmanifold_edges + after.nonmanifold_vertices == 0);
        const MapQuality map = map_quality(level.mesh, level.map, true);
        CHECK(map.unmapped + map.outside_simplex + map.flipped_triangles == 0);

        // The colours outside change nothing.
        for (std::size_t i = 0; i < image.pixel_count(); ++i)
            if (!mask.contains(i)) std::fill_n(&image.data[3 * i], 3, 1.0f);
        const BaseMesh again = build_mesh_image(image, refined, {}, mask).mesh_image.levels[0].mesh;
        CHECK(again.position == level.mesh.position);
        CHECK(again.feature == level.mesh.feature);
    }
}

}  // namespace imgmesh::test
