#include "formats/export/outlines.h"

#include <nlohmann/json.hpp>

#include "formats/export/text_numbers.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

using nlohmann::json;

// The place of a ring's corner i, from the image's corner, joined by `between`.
std::string place(const Vec2d& p, const char* between) {
    return number_text(static_cast<float>(p.x() + 0.5)) + between +
           number_text(static_cast<float>(p.y() + 0.5));
}

std::string ring_json(const Loop& loop) {
    return '[' +
           joined_text(loop.size(), ",", [&](std::size_t i) { return '[' + place(loop[i], ",") + ']'; }) +
           ']';
}

std::string quoted(const std::string& text) {
    return json(text).dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

std::string outline_json(const std::vector<Loop>& loops, const std::vector<std::vector<std::size_t>>& parts,
                         const OutlineFacts& facts) {
    return cat(R"({"$schema":"imgmesh-convert.outline.schema.json","generator":)", quoted(facts.generator),
               R"(,"input":)", quoted(facts.input), R"(,"width":)", facts.size.width, R"(,"height":)",
               facts.size.height, R"(,"tolerance":)", number_text(static_cast<float>(facts.tolerance)),
               R"(,"side":)", facts.side == OutlineSide::kOut ? R"("out")" : R"("both")", R"(,"parts":[)",
               joined_text(parts.size(), ",",
                           [&](std::size_t k) {
                               const std::vector<std::size_t>& part = parts[k];
                               return cat(
                                   R"({"outer":)", ring_json(loops[part[0]]), R"(,"holes":[)",
                                   joined_text(part.size() - 1, ",",
                                               [&](std::size_t h) { return ring_json(loops[part[h + 1]]); }),
                                   "]}");
                           }),
               "]}\n");
}

std::string outline_svg(const std::vector<Loop>& loops, const std::vector<std::vector<std::size_t>>& parts,
                        const OutlineFacts& facts) {
    const int w = facts.size.width, h = facts.size.height;
    std::string out = cat(R"(<svg xmlns="http://www.w3.org/2000/svg" width=")", w, R"(" height=")", h,
                          R"(" viewBox="0 0 )", w, ' ', h, R"(" fill-rule="evenodd">)", '\n');
    for (const std::vector<std::size_t>& part : parts) {
        out += R"(<path d=")";
        for (const std::size_t i : part)
            out += 'M' +
                   joined_text(loops[i].size(), "L", [&](std::size_t k) { return place(loops[i][k], " "); }) +
                   'Z';
        out += "\"/>\n";
    }
    return out + "</svg>\n";
}

}  // namespace imgmesh
