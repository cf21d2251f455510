// Containers whose pixel maps are a compact stream.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "formats/container/container.h"
#include "formats/container/validate.h"
#include "libcore/base/error.h"
#include "libcore/mesh/locate_map.h"
#include "tests/support/grid_mesh_image.h"
#include "tests/support/temporary_folder.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

// A mesh image of `levels` levels whose pixels lie anywhere on a grid; every third outside if `mask`.
MeshImage image_on_grid(int width, int height, int levels, bool mask, WeightPrecision precision,
                        std::uint32_t seed) {
    std::mt19937 random(seed);
    MeshImage image = grid_mesh_image(width, height, 6, 5, seed);
    image.generator = "test";
    image.source.has_mask = mask;
    image.levels.resize(as_index(levels));
    for (int k = 0; k < levels; ++k) {
        Level& level = image.levels[as_index(k)];
        if (k > 0) level.mesh = grid_mesh_image(width, height, 6 - k, 5 - k, seed + as_id(k)).levels[0].mesh;
        const int steps = 8 << random() % 3;
        Displacements places{{width, height}, steps, {}, {}, {}};
        if (mask) places.inside = Mask({width, height});
        const auto moved = [&](int pixel, int side) {
            const int to = pixel * steps + static_cast<int>(random() % 41) - 20;
            return static_cast<std::int16_t>(std::clamp(to, 0, (side - 1) * steps) - pixel * steps);
        };
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const bool inside = !mask || (x + y + k) % 3 > 0;
                places.dx.push_back(inside ? moved(x, width) : std::int16_t{0});
                places.dy.push_back(inside ? moved(y, height) : std::int16_t{0});
                if (mask) places.inside[places.inside.index(x, y)] = inside;
            }
        const LocatedMap located = locate_map(level.mesh, places, precision);
        REQUIRE(!located.lost);
        level.map = located.map;
    }
    return image;
}

ContainerOptions with(LayerLayout layers, DracoMode draco) {
    ContainerOptions options;
    options.layers = layers;
    options.draco = draco;
    return options;
}

void check_same_maps(const MeshImage& a, const MeshImage& b) {
    REQUIRE(a.levels.size() == b.levels.size());
    for (std::size_t k = 0; k < a.levels.size(); ++k) {
        CHECK(a.levels[k].mesh.faces == b.levels[k].mesh.faces);
        CHECK(a.levels[k].map.values == b.levels[k].map.values);
        CHECK(a.levels[k].map.precision == b.levels[k].map.precision);
    }
    CHECK(a.visits == b.visits);
}

}  // namespace

TEST_CASE("compact container: both layouts hold the same map to the bit, and become each other") {
    const TemporaryFolder folder;
    std::uint32_t seed = 0;
    for (const auto& [width, height] : {std::pair(40, 30), std::pair(65, 3), std::pair(2, 50)})
        for (const DracoMode draco : {DracoMode::kEdgebreaker, DracoMode::kSequential, DracoMode::kOff})
            for (const char* extension : {".glb", ".gltf"})
                for (const WeightPrecision precision : {WeightPrecision::kHalf, WeightPrecision::kFloat}) {
                    const bool mask = ++seed % 2;
                    MeshImage image = image_on_grid(width, height, 1 + int(seed % 3), mask, precision, seed);
                    if (seed % 5 == 0) image.visits.assign(image.levels[0].map.size(), seed);
                    const auto path = [&](const char* name) { return folder / cat(name, seed, extension); };
                    INFO(path(""));
                    write_container(path("compact"), image, with(LayerLayout::kCompact, draco));
                    write_container(path("exr"), image, with(LayerLayout::kExr, draco));
                    const Container compact = read_container(path("compact")),
                                    exr = read_container(path("exr"));
                    CHECK(compact.facts.layout == LayerLayout::kCompact);
                    CHECK(exr.facts.layout == LayerLayout::kExr);
                    check_same_maps(compact.mesh_image, exr.mesh_image);
                    CHECK(validate_container(path("compact")).empty());

                    // From either to the other; a mesh without Draco keeps its order.
                    write_container(path("from-exr"), exr.mesh_image,
                                    with(LayerLayout::kCompact, DracoMode::kOff));
                    write_container(path("from-compact"), compact.mesh_image,
                                    with(LayerLayout::kExr, DracoMode::kOff));
                    check_same_maps(read_container(path("from-exr")).mesh_image, compact.mesh_image);
                    check_same_maps(read_container(path("from-compact")).mesh_image, exr.mesh_image);
                }
}

TEST_CASE("compact container: a map off the grid has no compact form, and nothing is written") {
    const TemporaryFolder folder;
    MeshImage image = image_on_grid(40, 30, 2, false, WeightPrecision::kFloat, 3);
    image.levels[1].map.at(20, 10) = {3, 1.0f / 3 - std::remainder(1.0f / 3, kFloatWeightStep), 0.25f};
    const std::string path = folder / "a.gltf";
    CHECK_THROWS_WITH_AS(write_container(path, image, with(LayerLayout::kCompact, DracoMode::kEdgebreaker)),
                         doctest::Contains("lod1 has no compact form"), Error);
    CHECK(std::filesystem::is_empty(std::filesystem::path(path).parent_path()));
}

TEST_CASE("compact container: a validator looks for no pixels on a broken mesh") {
    const TemporaryFolder folder;
    const std::string path = folder / "a.gltf", mesh = folder / "a.bin";
    write_container(path, image_on_grid(40, 30, 1, false, WeightPrecision::kHalf, 5),
                    with(LayerLayout::kCompact, DracoMode::kOff));
    std::fstream(mesh, std::ios::in | std::ios::out | std::ios::binary).write("\xff\xff\xff\x7f", 4);
    std::vector<std::string> codes;
    for (const Issue& issue : validate_container(path)) codes.emplace_back(issue.finding->code);
    CHECK(codes == std::vector<std::string>{"mesh.topology", "mesh.index"});
}

TEST_CASE("compact container: the files of a .gltf follow the layout when it is written again") {
    const TemporaryFolder folder;
    const MeshImage image = image_on_grid(40, 30, 1, false, WeightPrecision::kHalf, 4);
    const std::string path = folder / "a.gltf";
    for (const LayerLayout layers : {LayerLayout::kExr, LayerLayout::kCompact, LayerLayout::kExr}) {
        const WrittenContainer written = write_container(path, image, with(layers, DracoMode::kEdgebreaker));
        CHECK(written.files == container_files(path, layers));
        CHECK(read_container(path).facts.files == written.files);
        std::size_t files = 0;
        for ([[maybe_unused]] const auto& entry :
             std::filesystem::directory_iterator(std::filesystem::path(path).parent_path()))
            ++files;
        CHECK(files == 3);
    }
}
