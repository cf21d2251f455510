// The texture of a container: how the reader handles a broken one, or one of another kind.
#include <doctest/doctest.h>

#include <set>
#include <string_view>

#include "formats/container/validate.h"
#include "formats/findings/finding_codes.h"
#include "tests/support/broken_container.h"
#include "tests/support/small_pictures.h"

using namespace imgmesh;
using namespace imgmesh::test;

TEST_CASE("container: a vertex's place in the texture is its pixel's") {
    MeshImage image = random_mesh_image(23, 18, 1, WeightPrecision::kHalf, false, 7);
    image.levels[0].mesh.position[0] = {0, 0};
    image.levels[0].mesh.position[1] = {22, 8.5f};
    const auto coords = texture_coords(image)[0];
    CHECK(coords[0] == Vec2f(0.5f / 23, 0.5f / 18));  // the centre of the first pixel
    CHECK(coords[1] == Vec2f(22.5f / 23, 0.5f));
}

TEST_CASE("refusals: the texture; one of another kind is for viewers alone") {
    Broken file;
    {
        const MeshImage image = random_mesh_image(20, 15, 2, WeightPrecision::kHalf, true, 5);
        ContainerOptions options{DracoMode::kOff, true};
        options.texture = {red_png(), texture_coords(image)};
        write_container(file.path, image, options);
    }
    const auto has_texture = [&](const auto& change) {
        bool found = false;
        const std::string code =
            file.with(change, [&] { found = !read_container(file.path).texture.picture.empty(); });
        CHECK(code == "");
        return found;
    };
    const auto view = [](const json& d) { return d["images"][0]["bufferView"].get<std::size_t>(); };
    const auto texcoord = [](json& d) -> json& {
        const auto index = d["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"].get<std::size_t>();
        return d["accessors"][index];
    };
    CHECK(has_texture([](json&) {}));
    CHECK(file.with([](json& d) { d["meshes"][0]["primitives"][0]["material"] = 1; }) == "gltf.index");
    CHECK(file.with([](json& d) { d["meshes"][0]["primitives"][0]["material"] = -1; }) == "gltf.structure");
    CHECK(file.with([](json& d) {
        d["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 1;
    }) == "gltf.index");
    CHECK(file.with([](json& d) { d["textures"][0]["source"] = 7; }) == "gltf.index");
    // A level whose image is not used counts as well; a validator reports it once.
    for (const std::size_t k : {0u, 1u}) {
        std::vector<Issue> issues;
        CHECK(file.with([&](json& d) { d["meshes"][k]["primitives"][0]["material"] = 7; },
                        [&] { issues = validate_container(file.path); }) == "gltf.index");
        REQUIRE(issues.size() == 1);
        CHECK(issues[0].finding->code == "gltf.index");
        CHECK(issues[0].place.pointer == cat("/meshes/", k, "/primitives/0/material"));
    }
    CHECK(file.with([](json& d) { d.erase("images"); }) == "gltf.index");
    CHECK(file.with([](json& d) { d["images"] = {{"0", 1}}; }) == "gltf.index");
    CHECK(file.with([](json& d) { d["images"][0]["bufferView"] = 77; }) == "gltf.index");
    CHECK(file.with([](json& d) { d["images"][0]["bufferView"] = -1; }) == "gltf.structure");
    CHECK(file.with([&](json& d) { d["bufferViews"][view(d)]["byteLength"] = 2000000000; }) == "gltf.range");
    CHECK(file.with([&](json& d) { texcoord(d)["type"] = "VEC3"; }) == "mesh.accessor");
    CHECK(file.with([&](json& d) { texcoord(d)["count"] = 3; }) == "mesh.counts");
    CHECK(file.with([&](json& d) { texcoord(d)["bufferView"] = 77; }) == "gltf.index");
    CHECK(file.with([&](json& d) { texcoord(d)["byteOffset"] = 4; }) == "gltf.range");
    CHECK(file.with([](json& d) { d["meshes"][0]["primitives"][0]["attributes"].erase("_COLOR"); }) ==
          "gltf.attribute");
    // What viewers do with it is for a validator to report.
    const auto lint_codes = [&](const auto& change) {
        std::set<std::string_view> codes;
        file.with(change, [&] {
            for (const Issue& issue : validate_container(file.path)) codes.insert(issue.finding->code);
        });
        return codes;
    };
    using Codes = std::set<std::string_view>;
    const auto attributes = [](json& d) -> json& { return d["meshes"][0]["primitives"][0]["attributes"]; };
    CHECK(lint_codes([&](json& d) { attributes(d)["COLOR_0"] = attributes(d)["_COLOR"]; }) ==
          Codes{"gltf.texture"});
    CHECK(lint_codes([&](json& d) { attributes(d).erase("TEXCOORD_0"); }) ==
          Codes{"gltf.texture", "gltf.unused"});
    CHECK(lint_codes([&](json& d) { d["materials"][0].erase("pbrMetallicRoughness"); }) ==
          Codes{"gltf.texture"});
    CHECK(lint_codes([&](json& d) { d["images"][0]["mimeType"] = "image/ktx2"; }) == Codes{"gltf.foreign"});
    CHECK(lint_codes([&](json& d) { d["images"][0]["mimeType"] = "image/jpeg"; }) == Codes{"texture.data"});
    CHECK_FALSE(has_texture([](json& d) { d["materials"][0].erase("pbrMetallicRoughness"); }));
    CHECK_FALSE(has_texture([](json& d) { d["textures"][0].erase("source"); }));
    CHECK_FALSE(has_texture([](json& d) { d["images"][0]["mimeType"] = "image/ktx2"; }));
    CHECK_FALSE(has_texture([](json& d) { d["images"] = {{{"uri", "../secret.png"}}}; }));
    CHECK_FALSE(has_texture([&](json& d) { d["bufferViews"][view(d)]["byteLength"] = 3; }));
    CHECK_FALSE(
        has_texture([](json& d) { d["meshes"][1]["primitives"][0]["attributes"].erase("TEXCOORD_0"); }));
}
