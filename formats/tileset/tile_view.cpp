#include "formats/tileset/tile_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "formats/files/atomic_file.h"
#include "formats/gltf/byte_range.h"
#include "formats/gltf/draco_mesh.h"
#include "formats/gltf/glb.h"
#include "formats/gltf/gltf_asset.h"
#include "formats/gltf/gltf_names.h"
#include "formats/gltf/stored_mesh.h"

namespace imgmesh {
namespace {

using nlohmann::json;

// glTF 2.0's numbers.
constexpr int kUnsignedInt = 5125, kUnsignedShort = 5123, kFloat = 5126;

// A side that the tile shares: where it lies, and how far its skirt moves along the axis.
struct SharedSide {
    std::size_t axis;
    float at, reach;

    bool holds(const std::array<float, 3>& position) const { return position[axis] == at; }
};

std::vector<SharedSide> shared_sides(const TileGrid& grid, const TileName& tile) {
    const PixelRect rect = grid.rect(tile);
    const auto units = [&](int pixels) { return static_cast<float>((pixels - 1) >> tile.level); };
    const SkirtReach reach = skirt_reach(grid, tile);
    std::vector<SharedSide> sides;
    if (reach.left > 0) sides.push_back({0, 0, -reach.left});
    if (reach.right > 0) sides.push_back({0, units(rect.width()), reach.right});
    if (reach.top > 0) sides.push_back({1, 0, reach.top});
    if (reach.bottom > 0) sides.push_back({1, -units(rect.height()), -reach.bottom});
    return sides;
}

// The strips outward of the sides. A corner between two shared sides goes out diagonally, so that the strips
// meet.
StoredMesh skirt_of(const StoredMesh& tile, const std::vector<SharedSide>& sides) {
    StoredMesh skirt;
    std::vector<Id> copy(tile.position.size(), kNone);  // in the skirt; the next one is its outer end
    const auto copied = [&](Id v) {
        if (copy[v] != kNone) return copy[v];
        copy[v] = static_cast<Id>(skirt.position.size());
        std::array<float, 3> out = tile.position[v];
        out[2] = -kSkirtDepth;
        for (const SharedSide& side : sides)
            if (side.holds(tile.position[v])) out[side.axis] += side.reach;
        skirt.position.push_back(tile.position[v]);
        skirt.position.push_back(out);
        if (!tile.color.empty()) skirt.color.insert(skirt.color.end(), 2, tile.color[v]);
        return copy[v];
    };
    for (const Face& face : tile.faces)
        for (std::size_t i = 0; i < 3; ++i)
            for (const SharedSide& side : sides) {
                const Id a = face[i], b = face[(i + 1) % 3];
                if (!side.holds(tile.position[a]) || !side.holds(tile.position[b])) continue;
                const Id from = copied(b), to = copied(a);  // the other way round, as it is on the other side
                skirt.faces.push_back({from, to, to + 1});
                skirt.faces.push_back({from, to + 1, from + 1});
            }
    return skirt;
}

// The document and its buffer, mesh by mesh.
class ViewWriter {
  public:
    ViewWriter(double scale, bool has_alpha, const std::string& generator) : scale_(scale) {
        document_ = {{"asset", {{"version", "2.0"}, {"generator", generator}}},
                     {"extensionsUsed", {kUnlit, kDraco}},
                     {"extensionsRequired", {kDraco}},
                     {"accessors", json::array()},
                     {"bufferViews", json::array()},
                     {"materials",
                      {{{"name", "unlit"},
                        {"doubleSided", true},
                        {"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                        {"extensions", {{kUnlit, json::object()}}}}}},
                     {"meshes", json::array()},
                     {"nodes", json::array()},
                     {"scenes", {{{"name", "tile"}, {"nodes", json::array()}}}},
                     {"scene", 0}};
        if (has_alpha) document_["materials"][0]["alphaMode"] = "BLEND";
    }

    void add(const std::string& name, const StoredMesh& mesh) {
        const DracoAttributeIds ids = draco_ids(mesh.layout());
        const DracoMesh draco = encode_draco_mesh(mesh, DracoMode::kEdgebreaker);
        const ByteRange bytes = append_values(buffer_, draco.bytes);
        const Bounds bounds = bounds_of(draco.decoded.position);
        const std::size_t vertices = draco.decoded.position.size();
        json attributes = {{"POSITION", accessor(kFloat, "VEC3", vertices)}};
        document_["accessors"].back().update({{"min", bounds.low}, {"max", bounds.high}});
        json stored = {{"POSITION", ids.position}};
        if (ids.color) {
            attributes["COLOR_0"] = accessor(kUnsignedShort, "VEC4", vertices);
            document_["accessors"].back()["normalized"] = true;
            stored["COLOR_0"] = *ids.color;
        }
        const std::size_t indices = accessor(kUnsignedInt, "SCALAR", 3 * draco.decoded.faces.size());
        const std::size_t view = document_["bufferViews"].size(), index = document_["meshes"].size();
        document_["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", bytes.offset}, {"byteLength", bytes.length}});
        const json primitive = {
            {"mode", 4},
            {"attributes", std::move(attributes)},
            {"indices", indices},
            {"material", 0},
            {"extensions", {{kDraco, {{"bufferView", view}, {"attributes", std::move(stored)}}}}}};
        document_["meshes"].push_back({{"name", name + "-mesh"}, {"primitives", json::array({primitive})}});
        document_["nodes"].push_back({{"name", name}, {"mesh", index}, {"scale", {scale_, scale_, scale_}}});
        document_["scenes"][0]["nodes"].push_back(index);
    }

    std::vector<std::uint8_t> glb() {
        document_["buffers"] = json::array({{{"byteLength", buffer_.size()}}});
        return pack_glb(document_.dump(-1, ' ', false, json::error_handler_t::replace), buffer_);
    }

  private:
    std::size_t accessor(int component, const char* type, std::size_t count) {
        document_["accessors"].push_back({{"componentType", component}, {"type", type}, {"count", count}});
        return document_["accessors"].size() - 1;
    }

    double scale_;
    json document_;
    std::vector<std::uint8_t> buffer_;
};

}  // namespace

SkirtReach skirt_reach(const TileGrid& grid, const TileName& tile) {
    const float unit = std::ldexp(1.0f, tile.level);
    const auto reach = [&](int columns, int rows, auto side) {
        const TileName other{tile.level, tile.column + columns, tile.row + rows};
        if (!grid.contains(other)) return 0.0f;
        const float steps = static_cast<float>(side(grid.rect(other)) - 1) / unit / kPositionStep;
        return std::clamp(std::floor(steps) * kPositionStep, kPositionStep, kSkirtWidth);
    };
    const auto width = [](const PixelRect& rect) { return rect.width(); };
    const auto height = [](const PixelRect& rect) { return rect.height(); };
    return {reach(-1, 0, width), reach(0, -1, height), reach(1, 0, width), reach(0, 1, height)};
}

void write_tile_view(const BaseMesh& mesh, const SourceInfo& source, const TileGrid& grid,
                     const TileName& tile, const std::string& generator, const std::string& path) {
    const StoredLayout layout = layout_of(source);
    StoredMesh stored = stored_from_base(mesh, layout);
    // What no viewer shows.
    stored.hdr.clear();
    stored.channels.clear();
    ViewWriter writer(static_cast<double>(std::int64_t{1} << tile.level), layout.alpha.has_value(),
                      generator);
    writer.add("tile", stored);
    const StoredMesh skirt = skirt_of(stored, shared_sides(grid, tile));
    if (!skirt.faces.empty()) writer.add("skirt", skirt);
    AtomicFile file(path, /*overwrite=*/true);
    file.write(writer.glb());
    file.commit();
}

}  // namespace imgmesh
