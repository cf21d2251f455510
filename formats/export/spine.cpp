// Sources: Esoteric Software, "Spine: JSON export format" and "Spine: Atlas export format".
#include "formats/export/spine.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "formats/export/text_numbers.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

std::string quoted(const std::string& text) {
    using nlohmann::json;
    return json(text).dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string region_name(const std::string& image) {
    return std::filesystem::path(image).stem().string();
}

std::string attachment(const BaseMesh& mesh, const DiscPart& part, const SourceInfo& source,
                       const std::string& region) {
    const auto width = static_cast<float>(source.width), height = static_cast<float>(source.height);
    const auto place = [&](std::size_t i) {
        const Vec2f& p = mesh.position[part.vertex[i]];
        return Vec2f(from_corner(p.x(), source.width), from_corner(p.y(), source.height));
    };
    const std::size_t count = part.vertex.size();
    BaseMesh own;  // with the part's own vertices, whose seams have two sides
    own.faces = part.faces;
    const auto edges = mesh_edges(own);
    return cat(R"({"type":"mesh","path":)", quoted(region), R"(,"uvs":[)",
               joined_text(count, ",",
                           [&](std::size_t i) {
                               const Vec2f p = place(i);
                               return number_text(p.x() / width) + ',' + number_text(p.y() / height);
                           }),
               R"(],"triangles":[)",
               joined_text(part.faces.size(), ",",
                           [&](std::size_t i) {
                               const auto& [a, b, c] = part.faces[i];
                               return cat(a, ',', b, ',', c);
                           }),
               R"(],"vertices":[)",
               joined_text(count, ",",
                           [&](std::size_t i) {
                               const Vec2f p = place(i);
                               return number_text(p.x() - width / 2) + ',' + number_text(height / 2 - p.y());
                           }),
               R"(],"hull":)", part.hull, R"(,"edges":[)",
               // Spine counts numbers here, two for each vertex.
               joined_text(edges.size(), ",",
                           [&](std::size_t i) { return cat(2 * edges[i].first, ',', 2 * edges[i].second); }),
               R"(],"width":)", source.width, R"(,"height":)", source.height, '}');
}

}  // namespace

std::string spine_json(const BaseMesh& mesh, const std::vector<DiscPart>& parts, const SourceInfo& source,
                       const std::string& image) {
    const std::string region = region_name(image),
                      folder = std::filesystem::path(image).parent_path().string();
    const auto name = [&](std::size_t i) {
        return quoted(parts.size() == 1 ? region : cat(region, '-', i + 1));
    };
    return cat(R"({"skeleton":{"spine":"4.2.0","x":)", number_text(-static_cast<float>(source.width) / 2),
               R"(,"y":)", number_text(-static_cast<float>(source.height) / 2), R"(,"width":)", source.width,
               R"(,"height":)", source.height, R"(,"images":)", quoted(folder.empty() ? "./" : folder + '/'),
               R"(},"bones":[{"name":"root"}],"slots":[)",
               joined_text(parts.size(), ",",
                           [&](std::size_t i) {
                               return cat(R"({"name":)", name(i), R"(,"bone":"root","attachment":)", name(i),
                                          '}');
                           }),
               R"(],"skins":[{"name":"default","attachments":{)",
               joined_text(parts.size(), ",",
                           [&](std::size_t i) {
                               return cat(name(i), ":{", name(i), ':',
                                          attachment(mesh, parts[i], source, region), '}');
                           }),
               R"(}}],"animations":{}})", '\n');
}

std::string spine_atlas(const SourceInfo& source, const std::string& image) {
    if (std::any_of(image.begin(), image.end(), [](unsigned char c) { return c < 32 || c == 127; }))
        throw Error(ErrorKind::kBadArgument,
                    "the image's name has a control character, which no atlas can hold");
    return cat(image, "\nsize: ", source.width, ", ", source.height, "\nfilter: Linear, Linear\n",
               region_name(image), "\nbounds: 0, 0, ", source.width, ", ", source.height, '\n');
}

}  // namespace imgmesh
