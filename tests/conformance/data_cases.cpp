#include <ImfChannelList.h>
#include <ImfPreviewImage.h>
#include <ImfStringAttribute.h>

#include <cmath>

#include "tests/conformance/cases.h"

namespace imgmesh::conformance {
namespace {

Case draco_case(std::function<void(Bytes&)> edit) {
    Case c{Sample(1, DracoMode::kEdgebreaker), false, {}, {}};
    c.sample.edit_bin = std::move(edit);
    return c;
}

Case draco_json(std::function<void(json&)> edit) {
    Case c{Sample(1, DracoMode::kEdgebreaker), false, {}, {}};
    c.sample.edit_json = std::move(edit);
    return c;
}

Case json_case(std::function<void(json&)> edit) {
    Case c;
    c.sample.edit_json = std::move(edit);
    return c;
}

Case mesh_case(const std::function<void(StoredMesh&)>& edit) {
    Case c;
    edit(c.sample.meshes[0]);
    return c;
}

// With a mask that a pixel is outside of, faces need not cover the image.
Case masked_case(const std::function<void(StoredMesh&)>& edit) {
    Case c = mesh_case(edit);
    c.sample.asset.source.has_mask = true;
    c.sample.parts[0].map[4] = {};
    return c;
}

Case exr_case(std::function<void(Exr&)> edit) {
    Case c;
    c.sample.edit_exr = std::move(edit);
    return c;
}

Case layers_case(std::function<void(Bytes&)> edit) {
    Case c;
    c.sample.edit_layers = std::move(edit);
    return c;
}

void add_draco_cases(std::map<std::string, Case>& cases) {
    cases["draco.header"] = draco_case([](Bytes& b) { b[0] = 'X'; });
    cases["draco.version"] = draco_case([](Bytes& b) { b[6] = 3; });
    cases["draco.metadata"] = draco_case([](Bytes& b) { b[10] = 0x80; });
    cases["draco.attributes"] = draco_json([](json& d) {
        d["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["attributes"]["COLOR_0"] =
            5;
    });
    cases["draco.data"] = draco_json([](json& d) { d["bufferViews"][0]["byteLength"] = 60; });
    cases["draco.tail"] = draco_json([](json& d) {
        d["bufferViews"][0]["byteLength"] = d["bufferViews"][0]["byteLength"].get<int>() + 4;
    });
    cases["draco.tail"].sample.edit_bin = [](Bytes& b) { b.resize(b.size() + 4); };
    cases["draco.mixed"] = {Sample(2), false, {}, {}};
    cases["draco.mixed"].sample.modes[1] = DracoMode::kSequential;
}

void add_mesh_cases(std::map<std::string, Case>& cases) {
    cases["mesh.accessor"] = json_case([](json& d) { d["accessors"][2]["normalized"] = false; });
    cases["mesh.counts"] =
        json_case([](json& d) { d["nodes"][0]["extensions"]["IMGMESH_pixel_map"]["vertices"] = 5; });
    cases["mesh.index"] = mesh_case([](StoredMesh& m) { m.faces[1][2] = 4; });
    cases["mesh.position"] = mesh_case([](StoredMesh& m) { m.position[1][1] = -2.01f; });
    cases["mesh.color"] = mesh_case([](StoredMesh& m) { m.color[3][3] = 0; });
    cases["mesh.light"] = mesh_case([](StoredMesh& m) {
        m.hdr = {{0, 0, 0}, {1, 2, 3}, {5, -1, 0}, {0, 0, 9}};
    });
    cases["mesh.light"].sample.asset.source.gamut = Gamut::kHdr;
    cases["mesh.channel"] = mesh_case([](StoredMesh& m) { m.channels = {{1, 2, INFINITY, 4}}; });
    cases["mesh.channel"].sample.asset.source.channel_names = {"R", "G", "B", "depth.Z"};
    cases["mesh.orientation"] = mesh_case([](StoredMesh& m) { std::swap(m.faces[0][0], m.faces[0][1]); });
    cases["mesh.topology"] = Case();
    cases["mesh.topology"].sample.edit_bin = [](Bytes& b) {
        std::swap_ranges(b.begin(), b.begin() + 12, b.begin() + 12);  // the two faces
    };
    cases["mesh.bounds"] = json_case([](json& d) { d["accessors"][1]["max"] = {3, 0, 0}; });
    cases["mesh.unused_vertex"] = mesh_case([](StoredMesh& m) {
        m.position.push_back({1, -1, 0});
        m.color.push_back(m.color[0]);
    });
    cases["mesh.duplicate_face"] = masked_case([](StoredMesh& m) { m.faces.push_back({1, 2, 0}); });
    cases["mesh.nonmanifold"] = masked_case([](StoredMesh& m) {
        m.position.push_back({1, -1.5f, 0});
        m.color.push_back(m.color[0]);
        m.faces.push_back({1, 2, 4});
    });
    cases["mesh.texcoord"] = Case();
    cases["mesh.texcoord"].sample.add_texture();
    cases["mesh.texcoord"].sample.meshes[0].texcoord[1] = {0.5f, NAN};
    cases["texture.data"] = Case();
    cases["texture.data"].sample.add_texture();
    cases["texture.data"].sample.texture[1] = 'p';
    cases["mesh.outside"] = masked_case([](StoredMesh& m) { m.position[3][0] = 2.75f; });
    cases["mesh.area"] = mesh_case([](StoredMesh& m) { m.position[3][0] = 1.5f; });
}

void add_header_cases(std::map<std::string, Case>& cases) {
    cases["layers.size"] = Case();
    cases["layers.size"].sample.asset.source.width = cases["layers.size"].sample.asset.source.height = 16000;
    cases["layers.magic"] = layers_case([](Bytes& b) { b[0] = 0; });
    cases["layers.header"] = layers_case([](Bytes& b) { b.resize(100); });
    cases["layers.attribute"] = exr_case([](Exr& e) { e.header.setPreviewImage(Imf::PreviewImage(2, 2)); });
    cases["layers.version"] =
        exr_case([](Exr& e) { e.header.insert("imgmesh:version", Imf::StringAttribute("2.0")); });
    cases["layers.type"] = layers_case([](Bytes& b) { b[5] |= 0x08; });  // the flag of deep data
    cases["layers.tiles"] = exr_case([](Exr& e) {
        e.tiled = true;
        e.header.setTileDescription({16, 16, Imf::MIPMAP_LEVELS});
    });
    cases["layers.parts"] = exr_case([](Exr& e) { e.header.setName("lod1"); });
    cases["layers.window"] = exr_case([](Exr& e) { e.header.displayWindow().max.x += 1; });
    cases["layers.compression"] = exr_case([](Exr& e) { e.header.compression() = Imf::PIZ_COMPRESSION; });
    cases["layers.channels"] =
        exr_case([](Exr& e) { e.header.channels().insert("G", Imf::Channel(Imf::FLOAT)); });
    cases["layers.missing"] = exr_case([](Exr& e) {
        e.header.channels() = Imf::ChannelList();
        e.header.channels().insert("face.id", Imf::Channel(Imf::UINT));
        e.header.channels().insert("bary.u", Imf::Channel(Imf::FLOAT));
    });
    cases["layers.topology"] = Case();
    cases["layers.topology"].sample.parts[0].topology = std::string(64, '0');
    cases["layers.unbound"] = exr_case([](Exr& e) { e.header.erase("imgmesh:topology"); });
}

void add_pixel_cases(std::map<std::string, Case>& cases) {
    cases["layers.data"] = layers_case([](Bytes& b) { b.resize(b.size() - 8); });
    cases["layers.face_range"] = exr_case([](Exr& e) { e.face[4] = e.face[5] = 2; });
    cases["layers.weights"] = exr_case([](Exr& e) { e.u[4] = 0.75f; });
    cases["layers.mask"] = exr_case([](Exr& e) { e.face[4] = kNone; });
    cases["layers.mask_unused"] = Case();
    cases["layers.mask_unused"].sample.asset.source.has_mask = true;
    cases["layers.grid"] = exr_case([](Exr& e) { e.u[4] = 0.1f; });
    cases["layers.visits"] = {Sample(2), false, {}, {}};
    cases["layers.visits"].sample.parts[1].visits.assign(9, 1);
}

}  // namespace

std::map<std::string, Case> data_cases() {
    std::map<std::string, Case> cases;
    add_draco_cases(cases);
    add_mesh_cases(cases);
    add_header_cases(cases);
    add_pixel_cases(cases);
    return cases;
}

}  // namespace imgmesh::conformance
