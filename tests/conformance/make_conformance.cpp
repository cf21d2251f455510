// make-conformance FOLDER: for each code of kFindings a container in FOLDER/CODE that has this finding and no
// other, in FOLDER/CODE+NAME further ones of a code, and containers without any in FOLDER/valid-*. Where an
// option is needed to see it, it stands in FOLDER/CODE/options. A code without a case here is an error.
#include <fstream>
#include <iostream>
#include <map>

#include "formats/findings/finding_codes.h"
#include "libcore/base/error.h"
#include "tests/conformance/cases.h"

using namespace imgmesh;
using namespace imgmesh::conformance;
namespace fs = std::filesystem;

namespace {

void write_case(const Case& c, const fs::path& folder) {
    c.sample.write(folder, c.glb);
    if (!c.options.empty()) std::ofstream(folder / "options") << c.options << '\n';
    if (c.after) c.after(folder);
}

int run(const fs::path& out) {
    fs::remove_all(out);
    int missing = 0;
    const std::map<std::string, Case> cases = all_cases();
    for (const Finding& finding : kFindings) {
        const auto found = cases.find(std::string(finding.code));
        if (found == cases.end()) {
            std::cerr << "no case for " << finding.code << '\n';
            ++missing;
        } else {
            write_case(found->second, out / found->first);
        }
    }
    if (cases.size() != std::size(kFindings) - static_cast<std::size_t>(missing)) {
        std::cerr << "a case for no code\n";
        ++missing;
    }
    for (const auto& [name, mode] :
         {std::pair("edgebreaker", DracoMode::kEdgebreaker), std::pair("sequential", DracoMode::kSequential),
          std::pair("none", DracoMode::kOff)})
        for (const int levels : {1, 3})
            for (const bool glb : {false, true})
                Sample(levels, mode)
                    .write(out / cat("valid-", name, "-", levels, glb ? "-glb" : "-gltf"), glb);
    for (const auto& [name, c] : compact_cases()) write_case(c, out / name);
    for (const bool glb : {false, true}) {
        Sample compact(3, DracoMode::kEdgebreaker);
        compact.asset.layout = LayerLayout::kCompact;
        compact.asset.source.has_mask = true;
        for (LayerPart& part : compact.parts) part.map[4] = {};
        compact.parts[0].visits.assign(9, 2);
        compact.write(out / cat("valid-compact", glb ? "-glb" : "-gltf"), glb);
    }
    Sample old;
    old.asset.version = "1.0";
    old.write(out / "valid-version-1.0", false);
    Sample masked;
    masked.asset.source.has_mask = true;
    masked.parts[0].map[4] = {};
    masked.parts[0].visits.assign(9, 2);
    masked.write(out / "valid-mask-visits", true);
    Sample channels(2, DracoMode::kEdgebreaker);
    channels.asset.source.channel_names = {"R", "G", "B", "depth.Z"};
    channels.asset.source.gamut = Gamut::kHdr;
    for (StoredMesh& mesh : channels.meshes) {
        mesh.hdr = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 4}};
        mesh.channels = {{0, -1, 2, 1e30f}};
    }
    channels.write(out / "valid-channels-light", true);
    for (const DracoMode mode : {DracoMode::kEdgebreaker, DracoMode::kOff})
        for (const bool glb : {false, true}) {
            Sample texture(2, mode);
            texture.add_texture();
            texture.write(
                out / cat("valid-texture", mode == DracoMode::kOff ? "" : "-draco", glb ? "-glb" : ""), glb);
        }
    Sample no_color;
    no_color.asset.source.channel_names = {"depth.Z"};
    no_color.meshes[0].color.clear();
    no_color.meshes[0].channels = {{0, -1, 2, 3}};
    no_color.write(out / "valid-no-color", false);
    Sample tiled;
    tiled.edit_exr = [](Exr& exr) {
        exr.tiled = true;
        exr.header.setTileDescription({16, 16, Imf::ONE_LEVEL});
    };
    tiled.write(out / "valid-tiled", false);
    return missing > 0;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: make-conformance FOLDER\n";
        return 2;
    }
    try {
        return run(argv[1]);
    } catch (const std::exception& e) {
        std::cerr << "make-conformance: " << e.what() << '\n';
        return 1;
    }
}
