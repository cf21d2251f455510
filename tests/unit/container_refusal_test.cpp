// Everything that read_container() refuses: a good file with one change at a time.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "formats/container/container.h"
#include "formats/files/atomic_file.h"
#include "formats/findings/finding_codes.h"
#include "formats/gltf/file_uri.h"
#include "formats/gltf/glb.h"
#include "formats/gltf/gltf_asset.h"
#include "libcore/base/error.h"
#include "tests/support/broken_container.h"
#include "tests/support/random_mesh_image.h"
#include "tests/support/temporary_folder.h"

using namespace imgmesh;
using namespace imgmesh::test;
using nlohmann::json;

namespace {

json& root(json& d) {
    return d["extensions"]["IMGMESH_pixel_map"];
}
json& level(json& d, int k) {
    return d["nodes"][static_cast<std::size_t>(k)]["extensions"]["IMGMESH_pixel_map"];
}

}  // namespace

TEST_CASE("refusals: the glTF part") {
    Broken file;
    CHECK(file.with([](json&) {}) == "");
    CHECK(file.with([](json& d) { d = 3; }) == "gltf.structure");
    CHECK(file.with([](json& d) { d.erase("asset"); }) == "gltf.structure");
    CHECK(file.with([](json& d) { d["asset"]["version"] = "1.0"; }) == "gltf.version");
    CHECK(file.with([](json& d) { d["extensionsRequired"] = {"KHR_new"}; }) == "gltf.required");
    CHECK(file.with([](json& d) { d.erase("nodes"); }) == "gltf.structure");
    CHECK(file.with([](json& d) { d["accessors"] = "x"; }) == "gltf.structure");
    CHECK(file.with([](json& d) { d["nodes"][0].erase("mesh"); }) == "gltf.structure");
    CHECK(file.with([](json& d) { d["nodes"][0]["mesh"] = 2; }) == "gltf.index");
    CHECK(file.with([](json& d) { d["nodes"][0]["mesh"] = std::int64_t{1} << 32; }) == "gltf.integer");
    CHECK(file.with([](json& d) { d["nodes"].push_back(7); }) == "gltf.structure");
    CHECK(file.with([](json& d) { d["meshes"][1]["primitives"].clear(); }) == "gltf.primitive");
    CHECK(file.with([](json& d) {
        d["meshes"][1]["primitives"].insert(d["meshes"][1]["primitives"].begin(), 5);
    }) == "gltf.primitive");
    CHECK(file.with([](json& d) { d["meshes"][1]["primitives"][0]["mode"] = 5; }) == "gltf.primitive");
    CHECK(file.with([](json& d) { d["meshes"][0]["primitives"][0]["attributes"].erase("COLOR_0"); }) ==
          "gltf.attribute");
    CHECK(file.with([](json& d) { d["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = -1; }) ==
          "gltf.attribute");
    CHECK(file.with([](json& d) { d["meshes"][0]["primitives"][0].erase("indices"); }) == "gltf.structure");
    CHECK(file.with([](json& d) { d["meshes"][0]["primitives"][0]["indices"] = 99; }) == "gltf.index");
    CHECK(file.with([](json& d) { d["accessors"][0]["componentType"] = 5123; }) == "mesh.accessor");
    CHECK(file.with([](json& d) { d["accessors"][1]["type"] = "VEC2"; }) == "mesh.accessor");
    CHECK(file.with([](json& d) { d["accessors"][2]["normalized"] = false; }) == "mesh.accessor");
    CHECK(file.with([](json& d) { d["accessors"][1].erase("max"); }) == "mesh.accessor");
    CHECK(file.with([](json& d) { d["accessors"][1]["count"] = 4; }) == "mesh.counts");
    CHECK(file.with([](json& d) { d["accessors"][1]["byteOffset"] = 4; }) == "gltf.range");
    CHECK(file.with([](json& d) { d["accessors"][1]["bufferView"] = 77; }) == "gltf.index");
    CHECK(file.with([](json& d) { d["bufferViews"][0]["buffer"] = 1; }) == "gltf.index");
    CHECK(file.with([](json& d) { d["bufferViews"][1]["byteStride"] = 16; }) == "mesh.accessor");
    CHECK(file.with([](json& d) { d["bufferViews"][0]["byteLength"] = 2000000000; }) == "gltf.range");
    CHECK(file.with([](json& d) { d["bufferViews"][0]["byteOffset"] = 2000000000; }) == "gltf.range");
    CHECK(file.with([](json& d) { d["bufferViews"][0]["byteOffset"] = std::uint64_t{1} << 63; }) ==
          "gltf.integer");
    CHECK(file.with([](json& d) { d["bufferViews"][0]["byteLength"] = 8; }) == "gltf.range");
    CHECK(file.with([](json& d) { d["buffers"].push_back(d["buffers"][0]); }) == "gltf.buffer");
    CHECK(file.with([](json& d) { d["buffers"][0]["byteLength"] = 1 << 24; }) == "gltf.buffer");
    CHECK(file.with([](json& d) { d["buffers"][0].erase("uri"); }) == "gltf.buffer");
}

TEST_CASE("refusals: the Draco extension in the JSON") {
    Broken file(DracoMode::kEdgebreaker);
    const auto draco = [](json& d) -> json& {
        return d["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"];
    };
    CHECK(file.with([&](json&) {}) == "");
    CHECK(file.with([&](json& d) { draco(d)["bufferView"] = 9; }) == "gltf.index");
    CHECK(file.with([&](json& d) { draco(d)["bufferView"] = -1; }) == "gltf.structure");
    CHECK(file.with([&](json& d) { draco(d)["bufferView"] = 1; }) == "mesh.counts");  // the other level's
    CHECK(file.with([&](json& d) { draco(d).erase("attributes"); }) == "gltf.structure");
    CHECK(file.with([&](json& d) { draco(d)["attributes"]["COLOR_0"] = 5; }) == "draco.attributes");
    CHECK(file.with([&](json& d) { draco(d) = 1; }) == "gltf.structure");
    // A Draco mesh larger than accessors and extension say.
    CHECK(file.with([&](json& d) {
        const int faces = level(d, 0)["faces"].get<int>() + 1;
        level(d, 0)["faces"] = faces;
        d["accessors"][0]["count"] = 3 * faces;
    }) == "mesh.counts");
}

TEST_CASE("refusals: IMGMESH_pixel_map") {
    Broken file;
    CHECK(file.with([](json& d) { d.erase("extensions"); }) == "ext.missing");
    CHECK(file.with([](json& d) { root(d) = json::array(); }) == "ext.member");
    CHECK(file.with([](json& d) { root(d)["version"] = "2.0"; }) == "ext.version");
    CHECK(file.with([](json& d) { root(d)["version"] = "1.7"; }) == "");
    CHECK(file.with([](json& d) { root(d).erase("build"); }) == "ext.member");
    CHECK(file.with([](json& d) { root(d)["build"]["x"] = nullptr; }) == "ext.member");
    CHECK(file.with([](json& d) { root(d)["build"]["x"] = std::uint64_t{1} << 63; }) == "ext.member");
    CHECK(file.with([](json& d) { root(d)["image"]["width"] = 0; }) == "limits.pixels");
    CHECK(file.with([](json& d) { root(d)["image"]["width"] = 200000; }) == "limits.pixels");
    CHECK(file.with([](json& d) { root(d)["image"]["width"] = -20; }) == "ext.member");
    CHECK(file.with([](json& d) { root(d)["image"]["width"] = 19; }) == "layers.window");
    CHECK(file.with([](json& d) { root(d)["image"]["width"] = root(d)["image"]["height"] = 16000; }) ==
          "layers.size");
    CHECK(file.with([](json& d) { root(d)["image"]["colorSpace"] = "CMYK"; }) == "ext.value");
    CHECK(file.with([](json& d) { root(d)["image"]["sampleType"] = "int"; }) == "ext.value");
    CHECK(file.with([](json& d) { root(d)["image"]["channels"] = {1}; }) == "ext.member");
    CHECK(file.with([](json& d) { root(d)["image"]["hasMask"] = 1; }) == "ext.member");
    CHECK(file.with([](json& d) { root(d)["image"]["hasMask"] = false; }) == "layers.mask");
    CHECK(file.with([](json& d) { root(d)["layers"]["mimeType"] = "image/png"; }) == "ext.value");
    CHECK(file.with([](json& d) { root(d)["layers"]["bufferView"] = 0; }) == "ext.layers");
    CHECK(file.with([](json& d) {
        root(d)["layers"].erase("uri");
        root(d)["layers"]["bufferView"] = 0;
    }) == "layers.magic");
    CHECK(file.with([](json& d) { level(d, 1)["part"] = "lod2"; }) == "ext.level");
    CHECK(file.with([](json& d) { level(d, 1)["part"] = "lod0"; }) == "ext.level");
    CHECK(file.with([](json& d) { d["nodes"][1].erase("extensions"); }) == "layers.parts");
    CHECK(file.with([](json& d) { d["nodes"][0].erase("extensions"); }) == "ext.level");
    CHECK(file.with([](json& d) {
        for (auto& node : d["nodes"]) node.erase("extensions");
    }) == "limits.levels");
    CHECK(file.with([](json& d) { level(d, 0)["faces"] = 601; }) == "limits.faces");  // more than 2 * 20 * 15
    CHECK(file.with([](json& d) { level(d, 0)["faces"] = 599; }) == "mesh.counts");
    CHECK(file.with([](json& d) { level(d, 0)["vertices"] = 2; }) == "mesh.counts");
    CHECK(file.with([](json& d) { level(d, 0)["error"] = "x"; }) == "ext.member");
    CHECK(file.with([](json& d) { level(d, 0)["topology"] = "ab"; }) == "ext.member");
    CHECK(file.with([](json& d) { level(d, 0)["topology"] = std::string(64, '0'); }) == "mesh.topology");
}

TEST_CASE("refusals: docs/format.md lists every code, each is a code once") {
    const Bytes bytes = read_bytes(IMGMESH_DOCS "/format.md");
    const std::string text(bytes.begin(), bytes.end());
    std::set<std::string_view> codes;
    for (const Finding& f : kFindings) {
        INFO(f.code);
        const std::string_view severity = f.severity == Severity::kError     ? ""
                                          : f.severity == Severity::kWarning ? "warning | "
                                                                             : "info | ";
        CHECK(text.find(cat("| `", f.code, "` | ", severity, f.meaning, " |\n")) != std::string::npos);
        CHECK(codes.insert(f.code).second);
    }
    CHECK(codes.size() >= 60);
}

// The schemas and the reader agree on what is wrong.
TEST_CASE("refusals: every invalid example of the schemas") {
    Broken file;
    int examples = 0;
    for (const auto& entry : std::filesystem::directory_iterator(IMGMESH_SCHEMAS "/examples/invalid")) {
        const std::string name = entry.path().filename().string();
        const bool at_root = name.starts_with("glTF.IMGMESH_pixel_map.");
        if (!at_root && !name.starts_with("node.IMGMESH_pixel_map.")) continue;
        INFO(name);
        const Bytes text = read_bytes(entry.path().string());
        const json example = json::parse(text.begin(), text.end());
        // The node says that there are fewer vertices; the error must be found before that.
        const std::string code = file.with([&](json& d) { (at_root ? root(d) : level(d, 0)) = example; });
        CHECK((code.starts_with("ext.") || code.starts_with("limits.") || code == "uri.name" ||
               code == "mesh.counts"));
        ++examples;
    }
    CHECK(examples >= 20);
}

TEST_CASE("refusals: no form of a URI leaves the folder") {
    Broken file;
    for (const char* uri :
         {"../x.bin", "/etc/passwd", "a/x.bin", "..", ".", "", "%2e%2e%2fx.bin", "..%5Cx.bin", "a\\x.bin",
          "file:x.bin", "http://localhost/x", "data:application/octet-stream;base64,AA", "x.bin?y", "x.bin#y",
          "x%2", "x%zz", "x%00.bin", "x\n.bin"}) {
        INFO(uri);
        CHECK(file.with([&](json& d) { d["buffers"][0]["uri"] = uri; }) == "uri.name");
        CHECK(file.with([&](json& d) { root(d)["layers"]["uri"] = uri; }) == "uri.name");
    }
    CHECK(file.with([](json& d) { d["buffers"][0]["uri"] = "%78.bin"; }) == "");
    for (const char* name : {"plain", "a b", "ä%", "q?#:&+", "...", "~-_."})
        CHECK(name_from_uri(uri_from_name(name)) == name);
    CHECK(uri_from_name("a ü:.bin") == "a%20%C3%BC%3A.bin");
}

TEST_CASE("refusals: a mesh or layers that are not those the container was made with") {
    Broken file;
    const Bytes bin = read_bytes(file.folder / "x.bin");
    Bytes changed = bin;
    std::swap_ranges(changed.begin(), changed.begin() + 12, changed.begin() + 12);  // two faces swapped
    write_bytes(file.folder / "x.bin", changed);
    CHECK(refusal(file.path) == "mesh.topology");
    write_bytes(file.folder / "x.bin", bin);
    CHECK(refusal(file.path) == "");
    // An image of the same size, but of another mesh.
    write_container(file.folder / "y.gltf", random_mesh_image(20, 15, 1, WeightPrecision::kHalf, true, 6));
    std::filesystem::copy_file(file.folder / "y.exr", file.folder / "x.exr",
                               std::filesystem::copy_options::overwrite_existing);
    CHECK(refusal(file.path) == "layers.parts");
    std::filesystem::remove(file.folder / "x.exr");
    CHECK_THROWS_WITH_AS(read_container(file.path), doctest::Contains("x.exr: cannot read"), Error);
}

TEST_CASE("refusals: bytes, chunks, depth and limits") {
    const TemporaryFolder folder;
    const std::string path = folder / "x.glb";
    const MeshImage image = random_mesh_image(20, 15, 2, WeightPrecision::kHalf, true, 5);
    write_container(path, image);
    const Bytes good = read_bytes(path);

    const auto limits = [&](const auto& change) {
        ContainerLimits l;
        change(l);
        return refusal(path, l);
    };
    CHECK(limits([&](ContainerLimits& l) { l.max_bytes = good.size(); }) == "");
    CHECK(limits([&](ContainerLimits& l) { l.max_bytes = good.size() - 1; }) == "limits.bytes");
    CHECK(limits([](ContainerLimits& l) { l.max_pixels = 600; }) == "");
    CHECK(limits([](ContainerLimits& l) { l.max_pixels = 599; }) == "limits.pixels");  // of two levels
    CHECK(limits([](ContainerLimits& l) { l.max_pixels = 299; }) == "limits.pixels");
    CHECK(limits([](ContainerLimits& l) { l.max_memory = 1'000'000; }) == "");
    CHECK(limits([](ContainerLimits& l) { l.max_memory = 2 * 300 * 12; }) == "limits.memory");
    CHECK(limits([](ContainerLimits& l) { l.max_faces = 20; }) == "limits.faces");
    CHECK(limits([](ContainerLimits& l) { l.max_levels = 1; }) == "limits.levels");
    CHECK(limits([](ContainerLimits& l) { l.max_json_depth = 3; }) == "json.depth");

    const auto with = [&](const auto& change) {
        Bytes bytes = good;
        change(bytes);
        write_bytes(path, bytes);
        return refusal(path);
    };
    CHECK(with([](Bytes& b) { b[4] = 1; }) == "glb.header");
    CHECK(with([](Bytes& b) { b.push_back(0); }) == "glb.length");
    CHECK(with([](Bytes& b) { b[14] = 0x7F; }) == "glb.chunk");
    CHECK(with([](Bytes& b) { b[16] = 'X'; }) == "glb.chunk");
    CHECK(with([](Bytes& b) { b[21] = 0; }) == "json.syntax");
    CHECK(with([](Bytes& b) { b.clear(); }) == "json.syntax");

    write_text(path, "{\"asset\": " + std::string(100000, '[') + std::string(100000, ']') + "}");
    CHECK(refusal(path) == "json.depth");
    // Empty objects are the smallest JSON that takes the most memory.
    std::string objects = "{\"nodes\": [{}";
    for (int n = 0; n < 300000; ++n) objects += ",{}";
    write_text(path, objects + "]}");
    CHECK(refusal(path) == "limits.json");
    write_text(path, "{\"asset\": {\"version\": \"2.0\xFF\"}}");
    CHECK(refusal(path) == "json.syntax");
    // Some readers stop at a zero, others continue.
    write_text(path, "{\"asset\": {\"version\": \"2.0\"}}" + std::string(1, '\0') + " ");
    CHECK(refusal(path) == "json.syntax");
    // A quoted name cannot break the message's line.
    write_text(path, R"({"asset": {"version": "1.0\nimgmesh: all is well\u001b[31m"}})");
    CHECK(refusal(path) == "gltf.version");
}

TEST_CASE("refusals: truncated and flipped containers give an Error, never a crash") {
    const TemporaryFolder folder;
    const std::string path = folder / "x.glb";
    std::mt19937 random(8);
    for (const DracoMode mode : {DracoMode::kEdgebreaker, DracoMode::kSequential, DracoMode::kOff}) {
        write_container(path, random_mesh_image(20, 15, 2, WeightPrecision::kHalf, true, 5), {mode, true});
        const Bytes good = read_bytes(path);
        for (std::size_t length = 0; length < good.size(); length += 97) {
            write_bytes(path, std::span(good).first(length));
            CHECK(refusal(path) != "");
        }
        int refused = 0;
        for (int i = 0; i < 300; ++i) {
            Bytes bytes = good;
            bytes[random() % bytes.size()] ^= static_cast<std::uint8_t>(1 << random() % 8);
            write_bytes(path, bytes);
            refused += !refusal(path).empty();
        }
        CHECK(refused > 100);  // what passes changed a colour, a name, or bits that nothing reads
    }
}

TEST_CASE("glTF JSON: read(write(x)) == x") {
    Asset asset;
    asset.version = "1.0";
    asset.source = {640, 480, ColorSpace::kDisplayP3, SampleType::kHalf, {"Y", "ä"}, true, Gamut::kHdr};
    asset.generator = "test";
    asset.parameters = {{"a", std::int64_t{-5}}, {"b", 0.1}, {"c", std::string("x")}, {"d", false}};
    asset.buffer_length = 5000;
    asset.buffer_name = "ü ä.bin";
    asset.layers = {4000, 1000};
    asset.levels.resize(2);
    for (std::size_t k = 0; k < 2; ++k) {
        AssetLevel& l = asset.levels[k];
        l = {30, 40, 0.1 + double(k), std::string(64, 'a'), {{0, -479, 0}, {639, 0, 0}}, k == 0, {}, {}, {},
             {}, {}};
        l.ids = draco_ids(layout_of(asset.source));
        l.channels.resize(1);
        if (l.is_draco)
            l.draco = {0, 333};
        else {
            l.indices = {400, 480};
            l.positions = {880, 360};
            l.colors = {1240, 240};
            l.hdr = {1480, 360};
            l.channels[0] = {1840, 120};
        }
    }
    const auto check = [&] {
        const Asset back = asset_from_json(json_from_asset(asset), {});
        CHECK(back.version == asset.version);
        CHECK(back.source.channel_names == asset.source.channel_names);
        CHECK(back.source.gamut == asset.source.gamut);
        CHECK(back.source.color_space == asset.source.color_space);
        CHECK(back.source.sample_type == asset.source.sample_type);
        CHECK(back.source.width == 640);
        CHECK(back.source.height == 480);
        CHECK(back.source.has_mask);
        CHECK(back.generator == asset.generator);
        CHECK(back.parameters == asset.parameters);
        CHECK(back.levels == asset.levels);
        CHECK(back.buffer_length == asset.buffer_length);
        CHECK(back.buffer_name == asset.buffer_name);
        CHECK(back.layers == asset.layers);
        CHECK(back.layers_name == asset.layers_name);
    };
    check();
    asset.buffer_name = "";
    asset.layers = {};
    asset.layers_name = "x y.exr";
    check();
    asset.buffer_length = std::uint64_t{1} << 31;
    CHECK_THROWS_AS(json_from_asset(asset), Error);
}
