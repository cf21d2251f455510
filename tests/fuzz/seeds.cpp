#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <random>

#include "formats/container/container.h"
#include "formats/files/atomic_file.h"
#include "formats/picture/color/icc_profile.h"
#include "formats/picture/image_io.h"
#include "libcore/mesh/locate_map.h"
#include "tests/fuzz/small_seeds.h"
#include "tests/fuzz/targets.h"
#include "tests/support/grid_mesh_image.h"
#include "tests/support/random_mesh_image.h"
#include "tests/support/small_pictures.h"
#include "tests/support/temporary_folder.h"

namespace imgmesh::fuzz {
namespace {

// The files of a folder whose names match, in the order of their names.
template <typename Matches>
std::vector<Bytes> files_of(const char* folder, Matches&& matches) {
    std::vector<std::filesystem::path> paths;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (matches(entry.path())) paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    std::vector<Bytes> all;
    for (const auto& path : paths) all.push_back(read_file(path.string(), 1 << 20));
    return all;
}

std::vector<Bytes> codec_files(std::initializer_list<const char*> extensions) {
    return files_of(IMGMESH_TEST_DATA "/codecs", [&](const std::filesystem::path& path) {
        return std::count(extensions.begin(), extensions.end(), path.extension().string()) > 0;
    });
}

std::vector<Bytes> noise_images(const char* extension, std::initializer_list<int> channel_counts) {
    std::vector<Bytes> all;
    for (const int channels : channel_counts)
        for (const bool fine : {false, true}) {
            Image image = make_image(13, 9, channels);
            std::mt19937 random(3);
            for (float& sample : image.data) sample = static_cast<float>(random() % 256) / 255;
            if (channels == 2 || channels == 4) image.data.back() = 0.5f;
            WriteImageOptions options;
            const std::string kind = extension;
            if (fine && (kind == ".png" || kind == ".tif")) options.sample_type = SampleType::kUint16;
            if (fine && kind == ".exr") {
                options.sample_type = SampleType::kFloat;
                options.metadata = {{"capDate", "string", "2024:01:02 03:04:05"},
                                    {"comments", "string", "a\nb"},
                                    {"expTime", "float", {}, {0.5}},
                                    {"framesPerSecond", "rational", {}, {24000, 1001}},
                                    {"worldToCamera", "m44f", {}, std::vector<double>(16, 1)}};
            }
            const TemporaryFolder folder;
            const std::string path = folder / ("x" + kind);
            write_image(path, image, options);
            all.push_back(read_file(path, 1 << 20));
        }
    return all;
}

std::vector<Bytes> containers() {
    std::vector<Bytes> all;
    const TemporaryFolder folder;
    std::uint32_t seed = 1;
    for (const DracoMode mode : {DracoMode::kEdgebreaker, DracoMode::kSequential, DracoMode::kOff})
        for (const WeightPrecision precision : {WeightPrecision::kHalf, WeightPrecision::kFloat}) {
            const bool mask = ++seed % 2 == 0;
            MeshImage image = random_mesh_image(17, 11, 1 + int(seed % 3), precision, mask, seed);
            if (mask) image.visits.assign(image.levels[0].map.size(), 3);
            ContainerOptions options{mode, true};
            if (!mask) options.texture = {red_png(), texture_coords(image)};
            if (!mask) options.metadata = {{"comments", "string", "a"}, {"expTime", "float", {}, {0.5}}};
            write_container(folder / "x.glb", image, options);
            all.push_back(read_file(folder / "x.glb", 1 << 24));
        }
    return all;
}

// With compact layers, whose pixels lie all over the mesh.
std::vector<Bytes> compact_containers() {
    std::vector<Bytes> all;
    const TemporaryFolder folder;
    constexpr int kWidth = 17, kHeight = 11, kSteps = 8;
    for (const DracoMode mode : {DracoMode::kEdgebreaker, DracoMode::kOff})
        for (const bool mask : {false, true}) {
            MeshImage image = test::grid_mesh_image(kWidth, kHeight, 4, 3, 5);
            Displacements places{{kWidth, kHeight}, kSteps, {}, {}, {}};
            places.inside = Mask(places);
            std::mt19937 random(3);
            const auto moved = [&](int pixel, int side) {
                const int to = pixel * kSteps + static_cast<int>(random() % 41) - 20;
                return static_cast<std::int16_t>(std::clamp(to, 0, (side - 1) * kSteps) - pixel * kSteps);
            };
            for (int y = 0; y < kHeight; ++y)
                for (int x = 0; x < kWidth; ++x) {
                    const bool inside = !mask || (x + y) % 3 > 0;
                    places.dx.push_back(inside ? moved(x, kWidth) : std::int16_t{0});
                    places.dy.push_back(inside ? moved(y, kHeight) : std::int16_t{0});
                    places.inside[places.inside.index(x, y)] = inside;
                }
            Level& level = image.levels[0];
            level.map = locate_map(level.mesh, places, WeightPrecision::kHalf).map;
            image.source.has_mask = mask;
            if (mask) image.visits.assign(level.map.size(), 3);
            ContainerOptions options{mode, true};
            options.layers = LayerLayout::kCompact;
            write_container(folder / "x.glb", image, options);
            all.push_back(read_file(folder / "x.glb", 1 << 24));
        }
    return all;
}

Bytes text(std::string_view content) {
    return {content.begin(), content.end()};
}

}  // namespace

std::vector<Bytes> seeds(Target target) {
    switch (target) {
        case Target::kContainer: {
            std::vector<Bytes> all = containers();
            for (Bytes& file : compact_containers()) all.push_back(std::move(file));
            return all;
        }
        case Target::kPng:
            return noise_images(".png", {1, 2, 3, 4});
        case Target::kJpeg:
            return noise_images(".jpg", {1, 3});
        case Target::kTiff: {
            std::vector<Bytes> all = noise_images(".tif", {1, 3, 4});
            for (Bytes& file : files_of(IMGMESH_TEST_DATA "/tiff", [](const auto&) { return true; }))
                all.push_back(std::move(file));
            return all;
        }
        case Target::kExr:
            return noise_images(".exr", {1, 3, 4});
        case Target::kWebp:
            return noise_images(".webp", {3, 4});
        case Target::kBmp:
            return bmp_seeds();
        case Target::kTga:
            return tga_seeds();
        case Target::kPnm:
            return netpbm_seeds();
        case Target::kGif:
            return codec_files({".gif"});
        case Target::kHdr:
            return codec_files({".hdr"});
        case Target::kJp2:
            return codec_files({".jp2", ".j2k"});
        case Target::kHeif:
            return codec_files({".heic", ".avif"});
        case Target::kProfile:
            return {icc_from_color_space(ColorSpace::kSrgb), icc_from_color_space(ColorSpace::kLinear)};
        case Target::kEdits:
            return files_of(IMGMESH_SCHEMAS "/examples/valid", [](const std::filesystem::path& path) {
                return path.filename().string().starts_with("imgmesh-warp.edits.");
            });
        case Target::kCompact:
            return compact_seeds();
        case Target::kCoded:
            return coded_seeds();
        case Target::kConfig:
            break;
    }
    return {text("density = 40\nquiet = true\nseed = 0x1F\nchannels = [\"R\", \"G\", 'B']\nname = 'x'\n"),
            text("# c\n\"density\" = 1.5e1\nname = \"\"\"a\\u00e9b\"\"\"\nchannels = [1, 2.5,\n true]\n")};
}

}  // namespace imgmesh::fuzz
