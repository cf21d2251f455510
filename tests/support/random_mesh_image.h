// Random but valid mesh images: what a container must carry without loss.
#pragma once

#include <algorithm>
#include <numeric>
#include <random>

#include "libcore/image/color.h"
#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

/// A grid of cells_x x cells_y cells, two triangles each, over an image of width x height, with interior
/// vertices moved, random colours, and vertices, faces and corners in random order. A side of one pixel is a
/// strip from -0.5 to 0.5, as in docs/format.md.
inline BaseMesh random_mesh(int width, int height, int cells_x, int cells_y, std::mt19937& random) {
    const auto uniform = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    const auto coordinate = [&](int i, int cells, int side) {
        const double low = side == 1 ? -0.5 : 0, high = side == 1 ? 0.5 : side - 1;
        const double cell = (high - low) / cells;
        const double moved = i == 0 || i == cells ? i * cell : (i + uniform(-0.2, 0.2)) * cell;
        return static_cast<float>(std::round((low + moved) / double(kPositionStep)) * double(kPositionStep));
    };
    const int columns = cells_x + 1, rows = cells_y + 1;
    std::vector<Id> order(static_cast<std::size_t>(columns * rows));
    std::iota(order.begin(), order.end(), 0u);
    std::shuffle(order.begin(), order.end(), random);

    BaseMesh mesh;
    mesh.position.resize(order.size());
    mesh.feature.resize(3 * order.size());
    const auto vertex = [&](int i, int j) { return order[static_cast<std::size_t>(j * columns + i)]; };
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const Id v = vertex(i, j);
            mesh.position[v] = {coordinate(i, cells_x, width), coordinate(j, cells_y, height)};
            std::array<std::uint16_t, 3> codes;
            for (auto& code : codes) code = static_cast<std::uint16_t>(random() & 0xFFFF);
            const Vec3f luv = color_from_codes(codes);
            std::copy(luv.data(), luv.data() + 3, mesh.feature_of(v));
        }
    for (int j = 0; j < cells_y; ++j)
        for (int i = 0; i < cells_x; ++i) {
            // Counter-clockwise as seen on screen, y down.
            const Id a = vertex(i, j), b = vertex(i, j + 1), c = vertex(i + 1, j + 1), d = vertex(i + 1, j);
            mesh.faces.push_back({a, b, c});
            mesh.faces.push_back({a, c, d});
        }
    for (Face& face : mesh.faces) std::rotate(face.begin(), face.begin() + random() % 3, face.end());
    std::shuffle(mesh.faces.begin(), mesh.faces.end(), random);
    return mesh;
}

/// Any face for any pixel, weights anywhere in the simplex, corners and edges included.
inline PixelMap random_map(int width, int height, std::size_t faces, WeightPrecision precision, bool mask,
                           std::mt19937& random) {
    PixelMap map{width, height, {}, precision};
    const float step = precision == WeightPrecision::kHalf ? kHalfWeightStep : kFloatWeightStep;
    const auto steps = static_cast<std::uint32_t>(1 / step);
    for (int i = 0; i < width * height; ++i) {
        if (mask && random() % 4 == 0) {
            map.values.push_back({});
            continue;
        }
        const std::uint32_t u = random() % 8 == 0 ? random() % 2 * steps : random() % (steps + 1);
        const std::uint32_t rest = steps - u;
        const std::uint32_t v = random() % 8 == 0 ? random() % 2 * rest : random() % (rest + 1);
        map.values.push_back(
            {static_cast<Id>(random() % faces), static_cast<float>(u) * step, static_cast<float>(v) * step});
    }
    return map;
}

/// Takes the colours away or makes them light of any brightness, and adds channels of any values.
inline void change_channels(MeshImage& image, bool color, bool light,
                            const std::vector<std::string>& auxiliary, std::mt19937& random) {
    image.source.gamut = color && light ? Gamut::kHdr : Gamut::kDisplay;
    image.source.channel_names = auxiliary;
    if (color) image.source.channel_names.insert(image.source.channel_names.begin(), {"R", "G", "B"});
    if (light) image.source.sample_type = SampleType::kFloat;
    for (Level& level : image.levels) {
        BaseMesh old = level.mesh;
        level.mesh.channels = (color ? 3 : 0) + static_cast<int>(auxiliary.size());
        level.mesh.feature.clear();
        for (Id v = 0; v < old.vertex_count(); ++v) {
            Vec3f luv(old.feature_of(v));
            const float scale = std::pow(10.0f, static_cast<float>(random() % 10) - 4);
            if (light) luv = quantized_color(luv_from_linear(linear_from_luv(luv) * scale), Gamut::kHdr);
            if (color) level.mesh.feature.insert(level.mesh.feature.end(), luv.data(), luv.data() + 3);
            for (std::size_t c = 0; c < auxiliary.size(); ++c)
                level.mesh.feature.push_back(scale * (static_cast<float>(random() % 2001) / 1000 - 1));
        }
    }
}

/// `levels` of them, each with about a quarter of the faces of the last.
inline MeshImage random_mesh_image(int width, int height, int levels, WeightPrecision precision, bool mask,
                                   std::uint32_t seed) {
    std::mt19937 random(seed);
    MeshImage image;
    image.source = {width, height, ColorSpace::kSrgb, SampleType::kUint8, {"R", "G", "B"}, mask};
    image.generator = "imgmesh-test 1";
    image.parameters = {{"zebra", true},
                        {"large", std::int64_t{1} << 52},
                        {"third", 1.0 / 3},
                        {"whole", 2.0},
                        {"name", std::string("flattened \"ü\"")}};
    for (int k = 0; k < levels; ++k) {
        const auto cells = [&](int side) { return std::max(1, (side - 1) / 2 >> k); };
        Level level;
        level.mesh = random_mesh(width, height, cells(width), cells(height), random);
        level.map = random_map(width, height, level.mesh.faces.size(), precision, mask, random);
        level.error = 12.1 * k;
        image.levels.push_back(std::move(level));
    }
    return image;
}

}  // namespace imgmesh
