#include "formats/container.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <map>

#include "formats/atomic_file.h"
#include "libcore/base/error.h"
#include "tests/support/random_mesh_image.h"
#include "tests/support/temporary_folder.h"

using namespace imgmesh;
namespace fs = std::filesystem;

namespace {

// Where a pixel is mapped to on the mesh and in what colour, in exact arithmetic: weights times positions and
// times 16-bit codes fit a double with bits to spare. So two maps that mean the same are equal here, however
// faces are numbered and corners rotated.
struct Mapped {
    std::array<double, 5> sum{};
    bool inside = false;
    bool operator==(const Mapped&) const = default;
};

std::vector<Mapped> mapped(const Level& level) {
    std::vector<Mapped> out;
    for (const PixelCoord& c : level.map.coords) {
        Mapped m;
        m.inside = c.face != kNone;
        const std::array<double, 3> weight = {1.0 - double(c.u) - double(c.v), double(c.u), double(c.v)};
        for (std::size_t i = 0; m.inside && i < 3; ++i) {
            const Id v = level.mesh.faces[c.face][i];
            const float* f = level.mesh.feature_of(v);
            const auto codes = color_codes(Vec3f(f[0], f[1], f[2]));
            m.sum[0] += weight[i] * double(level.mesh.position[v].x());
            m.sum[1] += weight[i] * double(level.mesh.position[v].y());
            for (std::size_t k = 0; k < 3; ++k) m.sum[2 + k] += weight[i] * codes[k];
        }
        out.push_back(m);
    }
    return out;
}

// The faces by their corners' positions and features, in an order of their own.
std::vector<std::array<std::array<float, 5>, 3>> face_set(const BaseMesh& mesh) {
    std::vector<std::array<std::array<float, 5>, 3>> faces;
    for (const Face& face : mesh.faces) {
        std::array<std::array<float, 5>, 3> corners;
        for (std::size_t i = 0; i < 3; ++i) {
            const float* f = mesh.feature_of(face[i]);
            corners[i] = {mesh.position[face[i]].x(), mesh.position[face[i]].y(), f[0], f[1], f[2]};
        }
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        faces.push_back(corners);
    }
    std::sort(faces.begin(), faces.end());
    return faces;
}

void check_same(const MeshImage& a, const MeshImage& b) {
    CHECK(a.source.width == b.source.width);
    CHECK(a.source.height == b.source.height);
    CHECK(a.source.color_space == b.source.color_space);
    CHECK(a.source.sample_type == b.source.sample_type);
    CHECK(a.source.channel_names == b.source.channel_names);
    CHECK(a.source.has_mask == b.source.has_mask);
    CHECK(a.generator == b.generator);
    CHECK(std::map(a.parameters.begin(), a.parameters.end()) ==
          std::map(b.parameters.begin(), b.parameters.end()));
    CHECK(a.visits == b.visits);
    REQUIRE(a.levels.size() == b.levels.size());
    for (std::size_t k = 0; k < a.levels.size(); ++k) {
        CHECK(a.levels[k].error == b.levels[k].error);
        CHECK(a.levels[k].map.precision == b.levels[k].map.precision);
        CHECK(face_set(a.levels[k].mesh) == face_set(b.levels[k].mesh));
        CHECK(mapped(a.levels[k]) == mapped(b.levels[k]));
    }
}

std::vector<std::uint8_t> bytes_of(const std::string& path) {
    return read_file(path, 1 << 24);
}

}  // namespace

TEST_CASE("container: what is read back is what was written, for every spelling, mode, precision and shape") {
    const TemporaryFolder folder;
    std::uint32_t seed = 0;
    const std::array<std::array<int, 2>, 5> sizes = {{{1, 1}, {1, 9}, {17, 1}, {23, 18}, {64, 40}}};
    for (const auto [width, height] : sizes)
        for (const DracoMode mode : {DracoMode::kEdgebreaker, DracoMode::kSequential, DracoMode::kOff})
            for (const WeightPrecision precision : {WeightPrecision::kHalf, WeightPrecision::kFloat})
                for (const char* extension : {".glb", ".gltf"}) {
                    const bool mask = ++seed % 2;
                    MeshImage image =
                        random_mesh_image(width, height, 1 + int(seed % 3), precision, mask, seed);
                    if (seed % 3 == 0) image.visits.assign(image.levels[0].map.coords.size(), seed);
                    const std::string path = folder / cat("a b\u00fc%", seed, extension);
                    INFO(path);
                    write_container(path, image, {mode, true});
                    const Container back = read_container(path);
                    check_same(image, back.mesh_image);
                    CHECK(back.facts.draco == mode);
                    CHECK(back.facts.version == "1.0");
                    std::uint64_t size = 0;
                    for (const char* part : {".glb", ".gltf", ".bin", ".exr"}) {
                        const fs::path file = fs::path(path).replace_extension(part);
                        if (fs::exists(file)) size += fs::file_size(file);
                    }
                    CHECK(back.facts.total_bytes == size);
                    CHECK(back.facts.mesh_bytes + back.facts.layer_bytes < size);
                    // What was read is already in the order that Draco chose for it: everything is lossless
                    // now.
                    const std::string again = folder / cat("again", extension);
                    write_container(again, back.mesh_image, {DracoMode::kOff, true});
                    check_same(image, read_container(again).mesh_image);
                }
    for (const auto& entry : fs::directory_iterator(folder.path()))
        CHECK(entry.path().filename().string().front() != '.');  // no temporary file is left
}

TEST_CASE("container: .glb and .gltf turn into each other without loss, and writing is deterministic") {
    const TemporaryFolder folder;
    const MeshImage image = random_mesh_image(30, 20, 2, WeightPrecision::kHalf, true, 99);
    write_container(folder / "a.glb", image);
    write_container(folder / "b.glb", image);
    CHECK(bytes_of(folder / "a.glb") == bytes_of(folder / "b.glb"));
    // A sequential mesh keeps its order, so whole files can be compared.
    const ContainerOptions sequential{DracoMode::kSequential, true};
    write_container(folder / "a.glb", image, sequential);
    write_container(folder / "c.gltf", read_container(folder / "a.glb").mesh_image, sequential);
    write_container(folder / "b.glb", read_container(folder / "c.gltf").mesh_image, sequential);
    CHECK(bytes_of(folder / "a.glb") == bytes_of(folder / "b.glb"));
}

// The check above must be able to fail: pixels mapped through a wrong permutation are not the same picture.
TEST_CASE("container: a wrong face, a wrong rotation and a swapped weight are all noticed") {
    const MeshImage image = random_mesh_image(30, 20, 1, WeightPrecision::kFloat, false, 7);
    const Level& level = image.levels[0];
    Level other = level;
    std::rotate(other.map.coords.begin(), other.map.coords.begin() + 1, other.map.coords.end());
    CHECK_FALSE(mapped(other) == mapped(level));
    other = level;
    for (PixelCoord& c : other.map.coords) c.face = (c.face + 1) % static_cast<Id>(level.mesh.faces.size());
    CHECK_FALSE(mapped(other) == mapped(level));
    other = level;
    for (Face& face : other.mesh.faces) std::rotate(face.begin(), face.begin() + 1, face.end());
    CHECK_FALSE(mapped(other) == mapped(level));
    CHECK(face_set(other.mesh) == face_set(level.mesh));
    other = level;
    for (PixelCoord& c : other.map.coords) std::swap(c.u, c.v);
    CHECK_FALSE(mapped(other) == mapped(level));
}

TEST_CASE("container: vertices without a face are dropped by edgebreaker and nothing else changes") {
    const TemporaryFolder folder;
    MeshImage image = random_mesh_image(12, 9, 1, WeightPrecision::kHalf, false, 3);
    image.levels[0].mesh.position.push_back({3, 3});
    image.levels[0].mesh.feature.insert(image.levels[0].mesh.feature.end(), {0, 0, 0});
    for (const DracoMode mode : {DracoMode::kEdgebreaker, DracoMode::kSequential, DracoMode::kOff}) {
        write_container(folder / "x.glb", image, {mode, true});
        check_same(image, read_container(folder / "x.glb").mesh_image);
    }
}

TEST_CASE("container: usage and files that are there already") {
    const TemporaryFolder folder;
    const MeshImage image = random_mesh_image(9, 9, 1, WeightPrecision::kHalf, false, 3);
    const auto code = [&](const char* name, bool overwrite) {
        try {
            write_container(folder / name, image, {DracoMode::kEdgebreaker, overwrite});
        } catch (const Error& error) {
            return error.code();
        }
        return ErrorCode::kOk;
    };
    CHECK(code("x.obj", true) == ErrorCode::kUsage);
    CHECK(code("x", true) == ErrorCode::kUsage);
    CHECK(code("a\\b.gltf", true) == ErrorCode::kUsage);
    CHECK(code("x.GLB", true) == ErrorCode::kOk);
    CHECK(code("none/x.glb", true) == ErrorCode::kIo);
    CHECK(code("x.gltf", false) == ErrorCode::kOk);
    CHECK(code("x.gltf", false) == ErrorCode::kIo);
    CHECK(code("x.gltf", true) == ErrorCode::kOk);
    // photo.exr may be the picture that the container is made from.
    AtomicFile photo(folder / "photo.exr", true);
    photo.commit();
    CHECK(code("photo.gltf", true) == ErrorCode::kOk);
    CHECK(bytes_of(folder / "photo.exr").empty());
    const std::vector<std::string> files = read_container(folder / "photo.gltf").facts.files;
    CHECK(files[1] == folder / "photo.bin");
    CHECK(fs::path(files[2]).filename().string().size() == std::string("photo-0123456789abcdef.exr").size());
    // The same again changes nothing, another container leaves nothing of the old one.
    CHECK(code("photo.gltf", true) == ErrorCode::kOk);
    CHECK(read_container(folder / "photo.gltf").facts.files == files);
    write_container(folder / "photo.gltf", random_mesh_image(9, 9, 1, WeightPrecision::kHalf, false, 4));
    for (const std::string& file : {files[1], files[2]}) CHECK_FALSE(fs::exists(file));
    CHECK(bytes_of(folder / "photo.exr").empty());
    CHECK_THROWS_AS(read_container(folder / "missing.glb"), Error);
}

TEST_CASE("container: the writer refuses parts that do not fit each other") {
    const TemporaryFolder folder;
    const auto refused = [&](const auto& change) {
        MeshImage image = random_mesh_image(9, 9, 2, WeightPrecision::kHalf, true, 3);
        change(image);
        CHECK_THROWS_AS(write_container(folder / "x.glb", image), Error);
        CHECK(fs::is_empty(folder.path()));
    };
    refused([](MeshImage& m) { m.levels.clear(); });
    refused([](MeshImage& m) { m.source.width = 8; });
    refused([](MeshImage& m) { m.levels[1].map.coords.pop_back(); });
    refused([](MeshImage& m) { m.visits.resize(5); });
    refused([](MeshImage& m) { m.levels[1].map.coords[5].face = 1000; });
    refused([](MeshImage& m) { m.source.has_mask = false; });
    refused([](MeshImage& m) { m.levels[0].error = INFINITY; });
    refused([](MeshImage& m) { m.parameters.emplace_back("x", double(NAN)); });
    refused([](MeshImage& m) { m.parameters.emplace_back("generator", true); });
}
