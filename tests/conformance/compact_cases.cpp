// Containers with compact layers, by what is broken; see docs/format.md, "What a reader refuses".
#include "tests/conformance/cases.h"

namespace imgmesh::conformance {
namespace {

Case compact_case(int levels = 1) {
    Case c{Sample(levels), false, {}, {}};
    c.sample.asset.layout = LayerLayout::kCompact;
    return c;
}

Case part_case(std::function<void(CompactPart&)> edit) {
    Case c = compact_case();
    c.sample.edit_compact = std::move(edit);
    return c;
}

Case stream_case(std::function<void(Bytes&)> edit) {
    Case c = compact_case();
    c.sample.edit_layers = std::move(edit);
    return c;
}

}  // namespace

std::map<std::string, Case> compact_cases() {
    std::map<std::string, Case> cases;
    cases["layers.size+compact"] = compact_case();
    SourceInfo& source = cases["layers.size+compact"].sample.asset.source;
    source.width = source.height = 16000;
    cases["layers.magic+compact"] = stream_case([](Bytes& b) { b[3] = 'p'; });
    cases["layers.magic+exr"] = Case();  // an EXR that is called a compact stream
    cases["layers.magic+exr"].sample.edit_json = [](json& d) {
        d["extensions"]["IMGMESH_pixel_map"]["layers"]["mimeType"] = media_type(LayerLayout::kCompact);
    };
    cases["layers.version+compact"] = stream_case([](Bytes& b) { b[4] = 2; });
    cases["layers.header+short"] = stream_case([](Bytes& b) { b.resize(20); });
    cases["layers.header+long"] = stream_case([](Bytes& b) { b.push_back(0); });
    cases["layers.header+steps"] = stream_case([](Bytes& b) { b[13] = 12; });
    cases["layers.header+flags"] = stream_case([](Bytes& b) { b[14] |= 0x10; });
    cases["layers.parts+compact"] = part_case([](CompactPart& p) { p.name = "lod1"; });
    cases["layers.parts+twice"] = compact_case(2);
    cases["layers.parts+twice"].sample.edit_compact = [](CompactPart& p) { p.name = "lod0"; };
    cases["layers.topology+compact"] = part_case([](CompactPart& p) { p.topology.assign(64, '0'); });
    cases["layers.window+compact"] = part_case([](CompactPart& p) {
        p.map.width = 4;
        p.map.dx.resize(12);
        p.map.dy.resize(12);
        p.map.inside = {};
    });
    cases["layers.data+band"] = stream_case([](Bytes& b) { b.back() ^= 0x55; });
    cases["layers.data+lost"] = part_case([](CompactPart& p) { p.map.dx[0] = -1; });
    cases["layers.mask+compact"] = part_case([](CompactPart& p) { p.map.inside[4] = 0; });
    cases["layers.unbound+compact"] = part_case([](CompactPart& p) { p.topology.clear(); });
    cases["layers.visits+compact"] = compact_case(2);
    cases["layers.visits+compact"].sample.parts[1].visits.assign(9, 1);
    cases["layers.mask_unused+compact"] = compact_case();
    cases["layers.mask_unused+compact"].sample.asset.source.has_mask = true;
    return cases;
}

}  // namespace imgmesh::conformance
