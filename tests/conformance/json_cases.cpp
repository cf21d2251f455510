#include <fstream>
#include <iterator>

#include "tests/conformance/cases.h"

namespace imgmesh::conformance {
namespace {

json& root(json& d) {
    return d["extensions"]["IMGMESH_pixel_map"];
}
json& level(json& d, std::size_t k) {
    return d["nodes"][k]["extensions"]["IMGMESH_pixel_map"];
}

Case json_case(std::function<void(json&)> edit, int levels = 1, DracoMode mode = DracoMode::kOff) {
    Case c{Sample(levels, mode), false, {}, {}};
    c.sample.edit_json = std::move(edit);
    return c;
}

Case text_case(std::function<void(std::string&)> edit) {
    Case c;
    c.sample.edit_text = std::move(edit);
    return c;
}

Case glb_case(std::function<void(Bytes&)> edit) {
    Case c;
    c.glb = true;
    c.sample.edit_glb = std::move(edit);
    return c;
}

Case limited(const std::string& options) {
    Case c;
    c.options = options;
    return c;
}

std::uint32_t number(const Bytes& b, std::size_t at) {
    return b[at] | std::uint32_t{b[at + 1]} << 8 | std::uint32_t{b[at + 2]} << 16 |
           std::uint32_t{b[at + 3]} << 24;
}
void set_number(Bytes& b, std::size_t at, std::size_t value) {
    for (std::size_t i = 0; i < 4; ++i) b[at + i] = static_cast<std::uint8_t>(value >> 8 * i);
}

std::string read_text(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

// One file for both: the EXR, and after it the mesh.
void join_files(const std::filesystem::path& folder) {
    std::string joined = read_text(folder / "x.exr");
    joined.resize((joined.size() + 3) / 4 * 4);
    json d = json::parse(read_text(folder / "x.gltf"));
    for (json& view : d["bufferViews"]) view["byteOffset"] = view.value("byteOffset", 0u) + joined.size();
    joined += read_text(folder / "x.bin");
    d["buffers"][0]["byteLength"] = joined.size();
    root(d)["layers"]["uri"] = "x.bin";
    const std::string text = d.dump();
    write_bytes(folder / "x.gltf", {text.begin(), text.end()});
    write_bytes(folder / "x.bin", {joined.begin(), joined.end()});
    std::filesystem::remove(folder / "x.exr");
}

void add_file_cases(std::map<std::string, Case>& cases) {
    cases["limits.bytes"] = limited("--max-bytes 100");
    cases["limits.json"] = Case();
    cases["limits.json"].after = [](const std::filesystem::path& folder) {
        std::filesystem::resize_file(folder / "x.gltf", (64 << 20) + 1);  // a hole: takes no room
    };
    cases["glb.header"] = glb_case([](Bytes& b) { b[4] = 1; });
    cases["glb.length"] = glb_case([](Bytes& b) { b[8] ^= 4; });
    cases["glb.chunk"] = glb_case([](Bytes& b) { b[16] = 'X'; });
    cases["glb.unknown_chunk"] = glb_case([](Bytes& b) {
        for (const char c : {'\0', '\0', '\0', '\0', 'T', 'E', 'S', 'T'})
            b.push_back(static_cast<std::uint8_t>(c));
        set_number(b, 8, b.size());
    });
    cases["glb.padding"] = glb_case([](Bytes& b) {
        const std::uint32_t length = number(b, 12);
        b.insert(b.begin() + 20 + length, ' ');
        set_number(b, 12, length + 1);
        set_number(b, 8, b.size());
    });
    cases["json.syntax"] = text_case([](std::string& t) { t.pop_back(); });
    cases["json.depth"] = text_case([](std::string& t) {
        t.pop_back();
        t += ",\"extras\":" + std::string(70, '[') + std::string(70, ']') + "}";
    });
    cases["json.bom"] = text_case([](std::string& t) { t = "\xEF\xBB\xBF" + t; });
    cases["json.duplicate"] = text_case([](std::string& t) { t = "{\"scene\":7," + t.substr(1); });
    cases["uri.name"] = json_case([](json& d) { d["buffers"][0]["uri"] = "../x.bin"; });
    cases["uri.same"] = Case();
    cases["uri.same"].after = join_files;
}

void add_gltf_cases(std::map<std::string, Case>& cases) {
    cases["gltf.version"] = json_case([](json& d) { d["asset"]["version"] = "1.0"; });
    cases["gltf.required"] = json_case([](json& d) { d["extensionsRequired"] = {"KHR_new"}; });
    cases["gltf.structure"] = json_case([](json& d) { d["asset"].erase("version"); });
    cases["gltf.primitive"] = json_case([](json& d) { d["meshes"][0]["primitives"][0]["mode"] = 5; });
    cases["gltf.attribute"] =
        json_case([](json& d) { d["meshes"][0]["primitives"][0]["attributes"].erase("COLOR_0"); });
    cases["gltf.integer"] = json_case([](json& d) { d["accessors"][0]["count"] = std::int64_t{1} << 40; });
    cases["gltf.index"] = json_case([](json& d) { d["nodes"][0]["mesh"] = 7; });
    cases["gltf.range"] = json_case([](json& d) { d["bufferViews"][2]["byteLength"] = 4096; });
    cases["gltf.buffer"] = json_case([](json& d) { d["buffers"].push_back(d["buffers"][0]); });
    cases["gltf.used"] = json_case([](json& d) { d["extensionsUsed"] = {"IMGMESH_pixel_map"}; });
    cases["gltf.draco_optional"] =
        json_case([](json& d) { d.erase("extensionsRequired"); }, 1, DracoMode::kEdgebreaker);
    cases["gltf.pixel_map_required"] =
        json_case([](json& d) { d["extensionsRequired"] = {"IMGMESH_pixel_map"}; });
    cases["gltf.scene"] = json_case([](json& d) { d["scenes"][0]["nodes"] = {0, 1}; }, 2);
    cases["gltf.names"] = json_case([](json& d) { d["meshes"][0]["name"] = "lod0"; });
    cases["gltf.lod"] = json_case(
        [](json& d) {
            d["nodes"][0]["extensions"]["MSFT_lod"]["ids"] = {2, 1};
        },
        3);
    cases["gltf.material"] = json_case([](json& d) { d["materials"][0]["doubleSided"] = false; });
    cases["gltf.transform"] = json_case([](json& d) { d["nodes"][0]["translation"] = {0, 0, 0}; });
    cases["gltf.texture"] = json_case([](json& d) {
        json& attributes = d["meshes"][0]["primitives"][0]["attributes"];
        attributes["COLOR_0"] = attributes["_COLOR"];  // which viewers multiply the texture by
        attributes.erase("_COLOR");
    });
    cases["gltf.texture"].sample.add_texture();
    cases["gltf.image"] = json_case([](json& d) {
        d["images"] = {{{"uri", "x.exr"}, {"mimeType", "image/x-exr"}}};
    });
    cases["gltf.overlap"] = json_case([](json& d) {
        d["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 4}});
        d["images"] = {{{"bufferView", 3}, {"mimeType", "image/png"}}};
    });
    cases["gltf.alignment"] = json_case([](json& d) {
        for (json& view : d["bufferViews"]) view["byteOffset"] = view.value("byteOffset", 0) + 2;
    });
    cases["gltf.alignment"].sample.edit_bin = [](Bytes& b) { b.insert(b.begin(), 2, 0); };
    cases["gltf.buffer_tail"] = json_case(
        [](json& d) { d["buffers"][0]["byteLength"] = d["buffers"][0]["byteLength"].get<int>() - 4; });
    cases["gltf.buffer_tail"].sample.edit_bin = [](Bytes& b) { b.resize(b.size() + 4); };
    cases["gltf.unused"] = json_case([](json& d) { d["accessors"].push_back(d["accessors"][0]); });
    cases["gltf.foreign"] = json_case([](json& d) { d["cameras"] = {{{"type", "perspective"}}}; });
}

void add_extension_cases(std::map<std::string, Case>& cases) {
    cases["limits.pixels"] = limited("--max-pixels 8");
    cases["limits.memory"] = limited("--max-memory 100");
    cases["limits.faces"] = json_case([](json& d) { level(d, 0)["faces"] = 19; });
    cases["limits.levels"] = json_case([](json& d) { d["nodes"][0].erase("extensions"); });
    cases["ext.missing"] = json_case([](json& d) { d.erase("extensions"); });
    cases["ext.version"] = json_case([](json& d) { root(d)["version"] = "2.0"; });
    cases["ext.member"] = json_case([](json& d) { root(d).erase("build"); });
    cases["ext.value"] = json_case([](json& d) { root(d)["image"]["colorSpace"] = "CMYK"; });
    cases["ext.channels"] = json_case([](json& d) {
        root(d)["image"]["channels"] = {"R", "G", "B", "Z", "Z"};
    });
    cases["ext.metadata"] = json_case([](json& d) {
        root(d)["image"]["metadata"]["compression"] = {{"type", "int"}, {"value", 1}};
    });
    cases["ext.layers"] = json_case([](json& d) { root(d)["layers"]["bufferView"] = 0; });
    cases["ext.level"] = json_case([](json& d) { level(d, 0)["part"] = "lod1"; });
    cases["ext.unknown"] = json_case([](json& d) { root(d)["image"]["depth"] = 8; });
    cases["ext.order"] = json_case([](json& d) { level(d, 0)["error"] = 7; }, 2);
}

}  // namespace

std::map<std::string, Case> json_cases() {
    std::map<std::string, Case> cases;
    add_file_cases(cases);
    add_gltf_cases(cases);
    add_extension_cases(cases);
    return cases;
}

}  // namespace imgmesh::conformance
