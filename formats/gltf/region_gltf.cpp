#include "formats/gltf/region_gltf.h"

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>

#include "formats/files/atomic_file.h"
#include "formats/files/extension.h"
#include "formats/gltf/glb.h"
#include "formats/gltf/gltf_asset.h"
#include "formats/gltf/gltf_names.h"
#include "formats/gltf/stored_mesh.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

using nlohmann::json;

constexpr std::uint64_t kMaxBytes = 0x7FFFFFFF;
// glTF 2.0's numbers.
constexpr int kUnsignedInt = 5125, kUnsignedShort = 5123, kFloat = 5126;
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;

struct Piece {
    Id region = kNone;
    std::size_t first_vertex = 0, vertices = 0, first_index = 0, indices = 0;
    Bounds bounds = {};
};

// The faces sorted by region, every region with its own copy of the vertices that it uses.
struct Pieces {
    std::vector<Piece> pieces;
    std::vector<std::array<float, 3>> position;
    std::vector<std::array<std::uint16_t, 4>> color;
    std::vector<Id> index;  // counted from the piece's first vertex
};

Pieces cut(const StoredMesh& mesh, std::span<const Id> region_of_face) {
    std::map<Id, std::vector<Id>> faces;
    for (Id f = 0; f < mesh.faces.size(); ++f)
        if (region_of_face[f] != kNone) faces[region_of_face[f]].push_back(f);
    Pieces out;
    std::vector<Id> copy(mesh.position.size(), kNone);
    for (const auto& [region, members] : faces) {
        Piece piece{region, out.position.size(), 0, out.index.size(), 3 * members.size()};
        std::vector<Id> used;
        for (const Id f : members)
            for (const Id v : mesh.faces[f]) {
                if (copy[v] == kNone) {
                    copy[v] = static_cast<Id>(used.size());
                    used.push_back(v);
                    out.position.push_back(mesh.position[v]);
                    out.color.push_back(mesh.color[v]);
                }
                out.index.push_back(copy[v]);
            }
        piece.vertices = used.size();
        piece.bounds = bounds_of(std::span(out.position).subspan(piece.first_vertex));
        for (const Id v : used) copy[v] = kNone;
        out.pieces.push_back(piece);
    }
    return out;
}

json accessor(int view, std::size_t offset, int component, const char* type, std::size_t count) {
    return {{"bufferView", view},
            {"byteOffset", offset},
            {"componentType", component},
            {"type", type},
            {"count", count}};
}

json document(const Pieces& pieces, const SourceInfo& source, const std::string& generator) {
    const std::size_t vertices = pieces.position.size(), indices = pieces.index.size();
    json accessors = json::array(), primitives = json::array(), materials = json::array();
    for (const Piece& piece : pieces.pieces) {
        const std::size_t at = accessors.size();
        accessors.push_back(accessor(0, 12 * piece.first_vertex, kFloat, "VEC3", piece.vertices));
        accessors.back()["min"] = piece.bounds.low;
        accessors.back()["max"] = piece.bounds.high;
        accessors.push_back(accessor(1, 8 * piece.first_vertex, kUnsignedShort, "VEC4", piece.vertices));
        accessors.back()["normalized"] = true;
        accessors.push_back(accessor(2, 4 * piece.first_index, kUnsignedInt, "SCALAR", piece.indices));
        primitives.push_back({{"mode", 4},
                              {"attributes", {{"POSITION", at}, {"COLOR_0", at + 1}}},
                              {"indices", at + 2},
                              {"material", materials.size()}});
        materials.push_back({{"name", cat("region-", piece.region)},
                             {"doubleSided", true},
                             {"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                             {"extensions", {{kUnlit, json::object()}}}});
    }
    const NodePlace place = node_place(source, 0);
    const json node = {{"name", "regions"},
                       {"mesh", 0},
                       {"scale", {place.scale, place.scale, place.scale}},
                       {"translation", {place.x, place.y, 0}}};
    const auto view = [](std::size_t offset, std::size_t length, int target) -> json {
        return {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", length}, {"target", target}};
    };
    json views = {view(0, 12 * vertices, kArrayBuffer), view(12 * vertices, 8 * vertices, kArrayBuffer),
                  view(20 * vertices, 4 * indices, kElementArrayBuffer)};
    views[0]["byteStride"] = 12;
    views[1]["byteStride"] = 8;
    return {{"asset", {{"version", "2.0"}, {"generator", generator}}},
            {"extensionsUsed", {kUnlit}},
            {"buffers", {{{"byteLength", 20 * vertices + 4 * indices}}}},
            {"bufferViews", std::move(views)},
            {"accessors", std::move(accessors)},
            {"materials", std::move(materials)},
            {"meshes", {{{"name", "regions-mesh"}, {"primitives", std::move(primitives)}}}},
            {"nodes", {node}},
            {"scenes", {{{"name", "regions-scene"}, {"nodes", {0}}}}},
            {"scene", 0}};
}

}  // namespace

void write_region_mesh(const std::string& path, const BaseMesh& mesh, std::span<const Id> region_of_face,
                       const SourceInfo& source, const std::string& generator, bool overwrite) {
    if (lower_extension(path) != ".glb")
        throw Error(ErrorKind::kBadArgument, cat(path, ": a region mesh is written as .glb"));
    AtomicFile file(path, overwrite);
    const Pieces pieces = cut(stored_from_base(mesh, layout_of(source)), region_of_face);
    if (pieces.pieces.empty())
        throw Error(ErrorKind::kUnsupported, cat(path, ": no face of the base mesh belongs to a region"));
    const std::uint64_t bytes = 20 * pieces.position.size() + 4 * pieces.index.size();
    if (bytes > kMaxBytes)
        throw Error(ErrorKind::kUnsupported,
                    cat(path, ": would have ", bytes, " bytes of vertices and faces"));
    std::vector<std::uint8_t> buffer;
    // Each is a multiple of four long, so that document() knows where they are.
    append_values(buffer, pieces.position);
    append_values(buffer, pieces.color);
    append_values(buffer, pieces.index);
    file.write(pack_glb(document(pieces, source, generator).dump(), buffer));
    file.commit();
}

}  // namespace imgmesh
