// write-samples FOLDER: a container of every flavour for the tests that use other software, and for each .glb
// the image (.ppm) that a reader must draw of its level 0. FOLDER/regions: base meshes in pieces.
// FOLDER/set: a tile set of three levels.
// FOLDER/compact: streams of displacements (.imap), and what a reader must find in their lod0 (.d16: dx, then
// dy).
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "formats/compact/compact_layers.h"
#include "formats/container/container.h"
#include "formats/gltf/region_gltf.h"
#include "tests/support/random_mesh_image.h"
#include "tests/support/sample_tile_set.h"
#include "tests/support/small_pictures.h"

using namespace imgmesh;

namespace {

// Colours change smoothly, so that colours between two vertices stay within what a display shows.
void paint(MeshImage& image) {
    for (Level& level : image.levels)
        for (Id v = 0; v < level.mesh.vertex_count(); ++v) {
            const Vec2f& p = level.mesh.position[v];
            const Vec3f linear(0.5f + 0.4f * std::sin(0.1f * p.x()), 0.5f + 0.4f * std::cos(0.13f * p.y()),
                               0.4f + 0.3f * std::sin(0.07f * (p.x() + p.y())));
            const Vec3f luv = quantized_color(luv_from_linear(linear));
            std::copy(luv.data(), luv.data() + 3, level.mesh.feature_of(v));
        }
}

void write_picture(const std::string& path, const MeshImage& image) {
    std::ofstream out(path, std::ios::binary);
    out << "P6\n" << image.source.width << " " << image.source.height << "\n255\n";
    const Level& level = image.levels[0];
    for (const PixelCoord& c : level.map) {
        Vec3f srgb(0, 0, 0);
        if (c.face != kNone) {
            const auto corner = [&](std::size_t i) {
                return Eigen::Map<const Vec3f>(level.mesh.feature_of(level.mesh.faces[c.face][i]));
            };
            const Vec3f luv = (1 - c.u - c.v) * corner(0) + c.u * corner(1) + c.v * corner(2);
            srgb = encoded_from_linear(ColorSpace::kSrgb, linear_from_luv(luv));
        }
        for (int i = 0; i < 3; ++i)
            out.put(static_cast<char>(std::lround(std::clamp(srgb[i], 0.f, 1.f) * 255)));
    }
}

// The same with a texture, as "texture ..."; with a depth, as "channels ...", and with light of up to 4 times
// what a display shows, as "light
// ...": there the image to expect is that of a quarter of the light.
void write_with_channels(const std::filesystem::path& folder, const std::string& name, const MeshImage& image,
                         DracoMode mode) {
    MeshImage channels = image, light = image;
    channels.source.channel_names = {"R", "G", "B", "depth.Z", "depth z"};
    light.source.gamut = Gamut::kHdr;
    light.source.color_space = ColorSpace::kLinear;
    light.source.sample_type = SampleType::kFloat;
    for (std::size_t k = 0; k < image.levels.size(); ++k) {
        BaseMesh& mesh = channels.levels[k].mesh;
        const BaseMesh& plain = image.levels[k].mesh;
        mesh.channels = 5;
        mesh.feature.clear();
        for (Id v = 0; v < plain.vertex_count(); ++v) {
            const float* f = plain.feature_of(v);
            mesh.feature.insert(mesh.feature.end(), f, f + 3);
            // Functions that interpolation does not change: what a pixel has is told by where it is mapped
            // to.
            mesh.feature.push_back(100 + plain.position[v].x());
            mesh.feature.push_back(-plain.position[v].y());
            const Vec3f luv = quantized_color(luv_from_linear(4 * linear_from_luv(Vec3f(f))), Gamut::kHdr);
            std::copy(luv.data(), luv.data() + 3, light.levels[k].mesh.feature_of(v));
        }
    }
    ContainerOptions texture{mode, true};
    texture.texture = {red_png(), texture_coords(image)};
    write_container((folder / ("texture " + name + ".glb")).string(), image, texture);
    write_container((folder / ("texture " + name + ".gltf")).string(), light, texture);
    write_container((folder / ("channels " + name + ".glb")).string(), channels, {mode, true});
    write_container((folder / ("light " + name + ".glb")).string(), light, {mode, true});
}

// Meshes without pixel maps, compressed for engines without Draco.
void write_plain(const std::filesystem::path& folder, const std::string& name, const MeshImage& image) {
    ContainerOptions options;
    options.layers = LayerLayout::kOff;
    options.meshopt = true;
    write_container((folder / (name + ".glb")).string(), image, options);
    options.texture = {red_png(), texture_coords(image)};
    write_container((folder / (name + ".gltf")).string(), image, options);
}

// Faces of any regions, one region of a single face, and some faces left out.
void write_regions(const std::filesystem::path& folder, const std::string& name, const MeshImage& image) {
    const BaseMesh& mesh = image.levels[0].mesh;
    std::vector<Id> region(mesh.faces.size());
    for (Id f = 0; f < region.size(); ++f) region[f] = f == 0 ? 100 : f % 7 == 3 ? kNone : f * f % 5;
    write_region_mesh((folder / (name + ".glb")).string(), mesh, region, image.source, "imgmesh-test 1",
                      true);
}

// Waves with noise, some of it large; with a mask and visits if `mask`.
void write_compact(const std::filesystem::path& folder, const std::string& name, int width, int height,
                   bool mask) {
    std::mt19937 random(7);
    std::vector<CompactPart> parts(2);
    for (const char* level : {"lod1", "lod0"}) {
        CompactPart& part = parts[level[3] == '0' ? 1 : 0];
        part = {level, {}, WeightPrecision::kHalf, {}, std::string(64, 'c')};
        Displacements& map = part.map;
        map.width = width;
        map.height = height;
        if (mask) map.inside = Mask(map, 1);
        for (std::size_t i = 0; i < map.pixel_count(); ++i) {
            const int x = map.x_of(i), y = map.y_of(i), noise = static_cast<int>(random() % 5) - 2;
            const bool outside = mask && (x - 10) * (x - 10) + (y - 20) * (y - 20) < 50;
            const double large = random() % 40 == 0 ? 300 : 1;
            const auto of = [&](double value) {
                return outside ? std::int16_t{0} : static_cast<std::int16_t>(value);
            };
            map.dx.push_back(of(20 * std::sin(0.1 * x + 0.2 * y) + noise * large));
            map.dy.push_back(of(9 * std::cos(0.2 * x) - 2 * noise));
            if (outside) map.inside[i] = 0;
            if (mask && level[3] == '0') part.visits.push_back(static_cast<Id>(random() % 9));
        }
    }
    const auto write = [&](const char* extension, const void* data, std::size_t size) {
        std::ofstream out(folder / (name + extension), std::ios::binary | std::ios::app);
        out.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
    };
    const std::vector<std::uint8_t> bytes = encode_compact_layers(parts);
    write(".imap", bytes.data(), bytes.size());
    for (const auto* d : {&parts[1].map.dx, &parts[1].map.dy}) write(".d16", d->data(), 2 * d->size());
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: write-samples FOLDER\n";
        return 2;
    }
    const std::filesystem::path folder = argv[1];
    std::filesystem::remove_all(folder);
    for (const char* name : {"regions", "plain", "compact"})
        std::filesystem::create_directories(folder / name);
    const std::pair<const char*, DracoMode> modes[] = {{"edgebreaker", DracoMode::kEdgebreaker},
                                                       {"sequential", DracoMode::kSequential},
                                                       {"none", DracoMode::kOff}};
    const std::pair<const char*, WeightPrecision> precisions[] = {{"half", WeightPrecision::kHalf},
                                                                  {"float", WeightPrecision::kFloat}};
    const std::array<std::array<int, 2>, 3> sizes = {{{96, 64}, {1, 9}, {1, 1}}};
    std::filesystem::create_directories(folder / "set");
    test::write_sample_set((folder / "set").string(), 100, 60, 32);
    write_compact(folder / "compact", "plain", 61, 45, false);
    write_compact(folder / "compact", "mask", 33, 70, true);
    write_compact(folder / "compact", "column", 1, 9, false);
    std::uint32_t seed = 0;
    for (const auto& [mode_name, mode] : modes)
        for (const auto& [precision_name, precision] : precisions)
            for (const auto [width, height] : sizes) {
                const bool mask = ++seed % 2 == 0;
                MeshImage image = random_mesh_image(width, height, 1 + int(seed % 3), precision, mask, seed);
                paint(image);
                if (mask) image.visits.assign(image.levels[0].map.size(), 3);
                const std::string name = std::string(mode_name) + " " + precision_name + " " +
                                         std::to_string(width) + "x" + std::to_string(height);
                for (const char* extension : {".glb", ".gltf"})
                    write_container((folder / (name + extension)).string(), image, {mode, true});
                write_picture((folder / (name + ".ppm")).string(), image);
                write_with_channels(folder, name, image, mode);
                if (mode == DracoMode::kOff) {
                    write_regions(folder / "regions", name, image);
                    write_plain(folder / "plain", name, image);
                }
            }
    return 0;
}
