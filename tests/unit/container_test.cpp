#include "formats/container/container.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <map>

#include "formats/container/validate.h"
#include "formats/files/atomic_file.h"
#include "libcore/base/error.h"
#include "libcore/image/feature_space.h"
#include "tests/support/random_mesh_image.h"
#include "tests/support/small_pictures.h"
#include "tests/support/temporary_folder.h"

using namespace imgmesh;
namespace fs = std::filesystem;

namespace {

// What is compared of a vertex: its place, its colour as stored (16-bit codes or HDR), and its channels.
std::vector<double> stored_values(const MeshImage& image, const BaseMesh& mesh, Id v) {
    std::vector<double> out{double(mesh.position[v].x()), double(mesh.position[v].y())};
    const float* f = mesh.feature_of(v);
    const float* const end = f + mesh.channels;
    if (!split_names(image.source.channel_names).color.empty()) {
        const Vec3f color(f);
        for (std::size_t k = 0; k < 3; ++k)
            out.push_back(image.source.gamut == Gamut::kHdr
                              ? quantized_hdr(color)[static_cast<Eigen::Index>(k)]
                              : float(color_codes(color)[k]));
        f += 3;
    }
    out.insert(out.end(), f, end);
    return out;
}

// A pixel's place on the mesh and its features there: sums of weights times values. They do not depend on the
// numbering of faces and the rotation of corners, because each sum starts from its least term.
struct Mapped {
    std::vector<double> sum;
    bool inside = false;
    bool operator==(const Mapped&) const = default;
};

std::vector<Mapped> mapped(const MeshImage& image, const Level& level) {
    std::vector<Mapped> out;
    for (const PixelCoord& c : level.map) {
        Mapped m;
        m.inside = c.face != kNone;
        const std::array<double, 3> weight = {1.0 - double(c.u) - double(c.v), double(c.u), double(c.v)};
        std::array<std::vector<double>, 3> values;
        for (std::size_t i = 0; m.inside && i < 3; ++i)
            values[i] = stored_values(image, level.mesh, level.mesh.faces[c.face][i]);
        for (std::size_t k = 0; k < values[0].size(); ++k) {
            std::array<double, 3> terms{};
            for (std::size_t i = 0; i < 3; ++i) terms[i] = weight[i] * values[i][k];
            std::sort(terms.begin(), terms.end());
            m.sum.push_back(terms[0] + terms[1] + terms[2]);
        }
        out.push_back(m);
    }
    return out;
}

// The faces by their corners' positions and features, in an order of their own.
std::vector<std::array<std::vector<float>, 3>> face_set(const BaseMesh& mesh) {
    std::vector<std::array<std::vector<float>, 3>> faces;
    for (const Face& face : mesh.faces) {
        std::array<std::vector<float>, 3> corners;
        for (std::size_t i = 0; i < 3; ++i) {
            const float* f = mesh.feature_of(face[i]);
            corners[i] = {mesh.position[face[i]].x(), mesh.position[face[i]].y()};
            corners[i].insert(corners[i].end(), f, f + mesh.channels);
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
    CHECK(a.source.gamut == b.source.gamut);
    CHECK(a.generator == b.generator);
    CHECK(std::map(a.parameters.begin(), a.parameters.end()) ==
          std::map(b.parameters.begin(), b.parameters.end()));
    CHECK(a.visits == b.visits);
    REQUIRE(a.levels.size() == b.levels.size());
    for (std::size_t k = 0; k < a.levels.size(); ++k) {
        CHECK(a.levels[k].error == b.levels[k].error);
        CHECK(a.levels[k].map.precision == b.levels[k].map.precision);
        CHECK(face_set(a.levels[k].mesh) == face_set(b.levels[k].mesh));
        CHECK(mapped(a, a.levels[k]) == mapped(b, b.levels[k]));
        CHECK(a.levels[k].mesh.channels == b.levels[k].mesh.channels);
    }
}

}  // namespace

TEST_CASE(
    "container: what is read back is what was written, for every file variant, mode, precision and shape") {
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
                    if (seed % 3 == 0) image.visits.assign(image.levels[0].map.size(), seed);
                    const std::string path = folder / cat("a b\u00fc%", seed, extension);
                    INFO(path);
                    write_container(path, image, {mode, true});
                    const Container back = read_container(path);
                    check_same(image, back.mesh_image);
                    CHECK(back.facts.draco == mode);
                    CHECK(back.facts.version == "1.1");
                    std::uint64_t size = 0;
                    for (const char* part : {".glb", ".gltf", ".bin", ".exr"}) {
                        const fs::path file = fs::path(path).replace_extension(part);
                        if (fs::exists(file)) size += fs::file_size(file);
                    }
                    CHECK(back.facts.total_bytes == size);
                    CHECK(back.facts.mesh_bytes + back.facts.layer_bytes < size);
                    // The mesh that was read is already in Draco's order, so everything is lossless now.
                    const std::string again = folder / cat("again", extension);
                    write_container(again, back.mesh_image, {DracoMode::kOff, true});
                    check_same(image, read_container(again).mesh_image);
                }
    for (const auto& entry : fs::directory_iterator(folder.path()))
        CHECK(entry.path().filename().string().front() != '.');  // no temporary file is left
}

TEST_CASE("container: channels and light are read back to the bit, in every mode") {
    const TemporaryFolder folder;
    std::mt19937 random(1);
    // Names that become the same attribute, and names that cause trouble in other software.
    const std::vector<std::string> odd = {"depth.Z", "depth z", "DEPTH_Z", "\u00fc", "A", "R"};
    std::vector<std::string> many;
    for (int c = 0; c < 13; ++c) many.push_back(cat("band", c));
    for (const bool color : {false, true})
        for (const bool light : {false, true})
            for (const auto& plain : {std::vector<std::string>{}, std::vector<std::string>{"Z"}, odd, many}) {
                if ((!color && (light || plain.empty())) || (color && plain == odd)) continue;
                MeshImage image = random_mesh_image(23, 18, 2, WeightPrecision::kHalf, false, 7);
                change_channels(image, color, light, plain, random);
                for (const DracoMode mode :
                     {DracoMode::kEdgebreaker, DracoMode::kSequential, DracoMode::kOff}) {
                    INFO(color << light << plain.size() << int(mode));
                    write_container(folder / "x.glb", image, {mode, true});
                    const MeshImage back = read_container(folder / "x.glb").mesh_image;
                    check_same(image, back);
                    write_container(folder / "y.gltf", back, {DracoMode::kOff, true});
                    check_same(image, read_container(folder / "y.gltf").mesh_image);
                }
            }
}

TEST_CASE("container: faces that differ by a channel alone are told apart") {
    const TemporaryFolder folder;
    std::mt19937 random(5);
    MeshImage image = random_mesh_image(12, 9, 1, WeightPrecision::kHalf, false, 3);
    change_channels(image, true, true, {"Z"}, random);
    // The same mesh once more on top, with other values of Z; every second pixel is mapped to the copy.
    BaseMesh& mesh = image.levels[0].mesh;
    const auto vertices = static_cast<Id>(mesh.vertex_count()), faces = static_cast<Id>(mesh.faces.size());
    for (Id v = 0; v < vertices; ++v) {
        mesh.position.push_back(mesh.position[v]);
        for (int c = 0; c < 4; ++c) mesh.feature.push_back(mesh.feature_of(v)[c] + (c == 3 ? 1.0f : 0.0f));
    }
    for (Id f = 0; f < faces; ++f) {
        const auto [a, b, c] = mesh.faces[f];
        mesh.faces.push_back({a + vertices, b + vertices, c + vertices});
    }
    for (std::size_t i = 0; i < image.levels[0].map.size(); i += 2) image.levels[0].map[i].face += faces;
    for (const DracoMode mode : {DracoMode::kEdgebreaker, DracoMode::kSequential, DracoMode::kOff}) {
        write_container(folder / "x.glb", image, {mode, true});
        check_same(image, read_container(folder / "x.glb").mesh_image);
    }
}

// Draco splits and reorders vertices. Each keeps its texture coordinates, which differ from its place in a
// warped mesh.
TEST_CASE("container: a texture and its coordinates are read back to the bit, in every mode") {
    const TemporaryFolder folder;
    for (const bool light : {false, true})
        for (const DracoMode mode : {DracoMode::kEdgebreaker, DracoMode::kSequential, DracoMode::kOff})
            for (const char* name : {"x.glb", "x.gltf"}) {
                INFO(light << int(mode) << name);
                std::mt19937 random(3);
                MeshImage image = random_mesh_image(23, 18, 3, WeightPrecision::kHalf, true, 7);
                change_channels(image, true, light, {"Z"}, random);
                ContainerOptions options{mode, true};
                options.texture = {red_png(), texture_coords(image)};
                // A function of the place, so that it can be checked in any order.
                const auto moved = [](const Vec2f& c) { return Vec2f(c.y() * c.y(), 1 - c.x()); };
                for (auto& level : options.texture.coords)
                    for (Vec2f& c : level) c = moved(c);
                write_container(folder / name, image, options);
                const Container back = read_container(folder / name);
                check_same(image, back.mesh_image);
                CHECK(back.texture.picture == red_png());
                CHECK(back.facts.texture_bytes == red_png().size());
                const auto places = texture_coords(back.mesh_image);
                REQUIRE(back.texture.coords.size() == 3);
                for (std::size_t k = 0; k < 3; ++k) {
                    REQUIRE(back.texture.coords[k].size() == places[k].size());
                    for (std::size_t v = 0; v < places[k].size(); ++v)
                        CHECK(back.texture.coords[k][v] == moved(places[k][v]));
                }
                CHECK(validate_container(folder / name).empty());
                // Without the texture the container is as if there had never been one.
                write_container(folder / name, back.mesh_image, {DracoMode::kOff, true});
                CHECK(read_container(folder / name).texture.picture.empty());
                check_same(image, read_container(folder / name).mesh_image);
            }
}

TEST_CASE("container: .glb and .gltf turn into each other without loss, and writing is deterministic") {
    const TemporaryFolder folder;
    const MeshImage image = random_mesh_image(30, 20, 2, WeightPrecision::kHalf, true, 99);
    write_container(folder / "a.glb", image);
    write_container(folder / "b.glb", image);
    CHECK(load(folder / "a.glb") == load(folder / "b.glb"));
    // A sequential mesh keeps its order, so whole files can be compared.
    const ContainerOptions sequential{DracoMode::kSequential, true};
    write_container(folder / "a.glb", image, sequential);
    write_container(folder / "c.gltf", read_container(folder / "a.glb").mesh_image, sequential);
    write_container(folder / "b.glb", read_container(folder / "c.gltf").mesh_image, sequential);
    CHECK(load(folder / "a.glb") == load(folder / "b.glb"));
}

// The check above must be able to fail: pixels mapped through a wrong permutation are not the same image.
TEST_CASE("container: a wrong face, a wrong rotation and a swapped weight are all noticed") {
    const MeshImage image = random_mesh_image(30, 20, 1, WeightPrecision::kFloat, false, 7);
    const Level& level = image.levels[0];
    Level other = level;
    std::rotate(other.map.begin(), other.map.begin() + 1, other.map.end());
    CHECK_FALSE(mapped(image, other) == mapped(image, level));
    other = level;
    for (PixelCoord& c : other.map) c.face = (c.face + 1) % static_cast<Id>(level.mesh.faces.size());
    CHECK_FALSE(mapped(image, other) == mapped(image, level));
    other = level;
    for (Face& face : other.mesh.faces) std::rotate(face.begin(), face.begin() + 1, face.end());
    CHECK_FALSE(mapped(image, other) == mapped(image, level));
    CHECK(face_set(other.mesh) == face_set(level.mesh));
    other = level;
    for (PixelCoord& c : other.map) std::swap(c.u, c.v);
    CHECK_FALSE(mapped(image, other) == mapped(image, level));
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

TEST_CASE("container: a channel's name without a byte of value 0") {
    const TemporaryFolder folder;
    MeshImage image = random_mesh_image(9, 9, 1, WeightPrecision::kHalf, false, 3);
    write_container(folder / "x.gltf", image, {});
    const auto bytes = load(folder / "x.gltf");
    std::string json(bytes.begin(), bytes.end());
    const std::size_t at = json.find("\"R\"");
    REQUIRE(at != std::string::npos);
    json.replace(at, 3, "\"R\\u0000\"");
    AtomicFile file(folder / "x.gltf", true);
    file.write({reinterpret_cast<const std::uint8_t*>(json.data()), json.size()});
    file.commit();
    CHECK_THROWS_AS(read_container(folder / "x.gltf"), Error);
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
    refused([](MeshImage& m) { m.levels[1].map.values.pop_back(); });
    refused([](MeshImage& m) { m.visits.resize(5); });
    refused([](MeshImage& m) { m.levels[1].map[5].face = 1000; });
    refused([](MeshImage& m) { m.source.has_mask = false; });
    refused([](MeshImage& m) { m.source.channel_names.push_back("Z"); });
    refused([](MeshImage& m) { m.source.channel_names = {"Z"}; });
    refused([](MeshImage& m) { m.levels[1].mesh.feature[4] = INFINITY; });
    refused([](MeshImage& m) { m.levels[0].error = INFINITY; });
    refused([](MeshImage& m) { m.parameters.emplace_back("x", double(NAN)); });
    refused([](MeshImage& m) { m.parameters.emplace_back("generator", true); });
    const MeshImage image = random_mesh_image(9, 9, 2, WeightPrecision::kHalf, true, 3);
    const auto refused_texture = [&](const auto& change) {
        ContainerOptions options;
        options.texture = {red_png(), texture_coords(image)};
        change(options.texture);
        CHECK_THROWS_AS(write_container(folder / "x.glb", image, options), Error);
        CHECK(fs::is_empty(folder.path()));
    };
    refused_texture([](Texture& t) { t.picture[0] = 'X'; });
    refused_texture([](Texture& t) { t.coords.pop_back(); });
    refused_texture([](Texture& t) { t.coords[1].pop_back(); });
}

TEST_CASE(
    "containers: a .glb that is too long says so before a file appears, a .gltf takes the layers apart") {
    const TemporaryFolder folder;
    const MeshImage image = random_mesh_image(64, 48, 1, WeightPrecision::kFloat, false, 7);
    const std::string glb = folder / "x.glb", gltf = folder / "x.gltf";
    const WrittenContainer whole = write_container(glb, image);
    const auto before = load(glb);
    const auto failure = [](const auto& action) -> std::string {
        try {
            action();
        } catch (const Error& error) {
            CHECK(error.kind() == ErrorKind::kUnsupported);
            return error.what();
        }
        return "";
    };
    ContainerOptions options;
    options.max_buffer_bytes = whole.mesh_bytes + whole.layer_bytes / 2;
    const std::string text = failure([&] { write_container(glb, image, options); });
    CHECK(text.find(glb) != std::string::npos);
    CHECK(text.find("a .gltf keeps the pixel maps") != std::string::npos);
    CHECK(failure([&] { write_container(folder / "new.glb", image, options); }) != "");
    CHECK(folder.count() == 1);
    CHECK(load(glb) == before);
    write_container(gltf, image, options);
    CHECK_NOTHROW(read_container(gltf));
    CHECK(validate_container(gltf).empty());
    // Meshes are in the buffer in any case.
    options.max_buffer_bytes = whole.mesh_bytes / 2;
    for (const std::string& path : {glb, gltf})
        CHECK(failure([&] { write_container(path, image, options); }).find("fewer vertices") !=
              std::string::npos);
}

TEST_CASE("containers: what is known of the buffer's length before the work") {
    ContainerOptions options;
    CHECK(check_buffer("x.glb", {1 << 20, 10000}, options) == "");
    CHECK(check_buffer("x.glb", {std::int64_t{1} << 30, 10000}, options).find("a .gltf keeps") !=
          std::string::npos);
    CHECK(check_buffer("x.gltf", {std::int64_t{1} << 30, 10000}, options) == "");
    // Draco may take nothing; without it, a vertex has a position at least.
    const ContainerPlan many{std::int64_t{1} << 28, std::int64_t{1} << 28};
    options.layers = LayerLayout::kOff;
    CHECK(check_buffer("x.glb", many, options) == "");
    options.draco = DracoMode::kOff;
    for (const char* path : {"x.glb", "x.gltf"}) CHECK_THROWS_AS(check_buffer(path, many, options), Error);
    options.meshopt = true;
    CHECK(check_buffer("x.glb", many, options) == "");
}
