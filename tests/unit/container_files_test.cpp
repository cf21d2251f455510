// The files of containers: names, those that are there already, and several writers.
#include <doctest/doctest.h>

#include <atomic>
#include <filesystem>
#include <optional>
#include <thread>

#include "formats/container/container.h"
#include "formats/files/atomic_file.h"
#include "libcore/base/error.h"
#include "tests/support/random_mesh_image.h"
#include "tests/support/temporary_folder.h"

using namespace imgmesh;
namespace fs = std::filesystem;

TEST_CASE("container: usage and files that are there already") {
    const TemporaryFolder folder;
    const MeshImage image = random_mesh_image(9, 9, 1, WeightPrecision::kHalf, false, 3);
    const auto code = [&](const char* name, bool overwrite) -> std::optional<ErrorKind> {
        try {
            write_container(folder / name, image, {DracoMode::kEdgebreaker, overwrite});
        } catch (const Error& error) {
            return error.kind();
        }
        return std::nullopt;
    };
    CHECK(code("x.obj", true) == ErrorKind::kBadArgument);
    CHECK(code("x", true) == ErrorKind::kBadArgument);
    CHECK(code("a\\b.gltf", true) == ErrorKind::kBadArgument);
    CHECK(code("x.GLB", true) == std::nullopt);
    CHECK(code("none/x.glb", true) == ErrorKind::kIo);
    CHECK(code("x.gltf", false) == std::nullopt);
    CHECK(code("x.gltf", false) == ErrorKind::kIo);
    CHECK(code("x.gltf", true) == std::nullopt);
    // photo.exr may be the image that the container is made from.
    AtomicFile photo(folder / "photo.exr", true);
    photo.commit();
    CHECK(code("photo.gltf", true) == std::nullopt);
    CHECK(load(folder / "photo.exr").empty());
    const std::vector<std::string> files = read_container(folder / "photo.gltf").facts.files;
    CHECK(files[1] == folder / "photo.bin");
    CHECK(fs::path(files[2]).filename().string().size() == std::string("photo-0123456789abcdef.exr").size());
    // The same container again changes nothing; another one leaves nothing of the old one.
    CHECK(code("photo.gltf", true) == std::nullopt);
    CHECK(read_container(folder / "photo.gltf").facts.files == files);
    write_container(folder / "photo.gltf", random_mesh_image(9, 9, 1, WeightPrecision::kHalf, false, 4));
    for (const std::string& file : {files[1], files[2]}) CHECK_FALSE(fs::exists(file));
    CHECK(load(folder / "photo.exr").empty());
    CHECK_THROWS_AS(read_container(folder / "missing.glb"), Error);
}

TEST_CASE("container: files that a .gltf merely names are not removed") {
    const TemporaryFolder folder;
    const MeshImage image = random_mesh_image(9, 9, 1, WeightPrecision::kHalf, false, 3);
    const auto put = [&](const char* name, const std::vector<std::uint8_t>& bytes) {
        AtomicFile file(folder / name, true);
        file.write(bytes);
        file.commit();
    };
    // The container's own .bin and .exr are exchanged for a person's files, and for those of another
    // container.
    write_container(folder / "photo.gltf", image, {});
    write_container(folder / "other.gltf", random_mesh_image(9, 9, 1, WeightPrecision::kHalf, false, 4), {});
    put("photo.bin", {1, 2, 3});
    write_container(folder / "photo.gltf", image, {});
    CHECK(load(folder / "photo.bin") == std::vector<std::uint8_t>{1, 2, 3});
    put("photo.bin", load(folder / "other.bin"));
    put("photo.exr", load(folder / "other.exr"));
    const auto others = load(folder / "photo.exr");
    write_container(folder / "photo.gltf", image, {});
    CHECK(load(folder / "photo.exr") == others);
    CHECK(read_container(folder / "photo.gltf").mesh_image.levels.size() == image.levels.size());
}

TEST_CASE("container: writers of one .gltf at the same time all succeed and leave one container") {
    const TemporaryFolder folder;
    std::vector<std::thread> writers;
    std::atomic<int> failed = 0;
    for (std::uint32_t seed = 3; seed < 9; ++seed)
        writers.emplace_back([&, seed] {
            const MeshImage image = random_mesh_image(9, 9, 1, WeightPrecision::kHalf, false, seed);
            for (int n = 0; n < 5; ++n) {
                try {
                    write_container(folder / "x.gltf", image, {});
                } catch (const Error&) {
                    ++failed;
                }
            }
        });
    for (std::thread& writer : writers) writer.join();
    CHECK(failed == 0);
    CHECK_NOTHROW(read_container(folder / "x.gltf"));
    CHECK(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()) == 3);
}
