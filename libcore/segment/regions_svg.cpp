#include "libcore/segment/regions_svg.h"

#include "libcore/base/error.h"
#include "libcore/base/svg_text.h"
#include "libcore/image/color.h"
#include "libcore/image/luv_encoder.h"

namespace imgmesh {
namespace {

void append_step(std::string& path, const OutlineStep& step, const Vec2d& end) {
    if (step.curve) {
        append_point(path, 'Q', step.control);
        append_point(path, ' ', end);
    } else {
        append_point(path, 'L', end);
    }
}

void append_arc(std::string& path, const OutlineArc& arc, bool reversed) {
    if (!reversed) {
        for (const OutlineStep& step : arc.steps) append_step(path, step, step.end);
        return;
    }
    for (std::size_t k = arc.steps.size(); k-- > 0;)
        append_step(path, arc.steps[k], k == 0 ? arc.start : arc.steps[k - 1].end);
}

}  // namespace

std::string regions_svg(const RegionOutlines& outlines, const std::vector<Vec3f>& colors) {
    std::string out =
        cat("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"", outlines.size.width, "\" height=\"",
            outlines.size.height, "\" viewBox=\"0 0 ", outlines.size.width, ' ', outlines.size.height,
            "\">\n<g fill-rule=\"evenodd\" stroke-width=\".5\" stroke-linejoin=\"round\">\n");
    for (std::size_t region = 0; region < outlines.rings.size(); ++region) {
        std::string color;
        append_hex(color, Vec3f(encoded_from_luv(ColorSpace::kSrgb, colors[region]) * 255).cast<double>());
        out += cat("<path id=\"region-", region, "\" data-label=\"", region, "\" fill=\"", color,
                   "\" stroke=\"", color, "\" d=\"");
        for (const OutlineRing& ring : outlines.rings[region]) {
            const OutlineArc& first = outlines.arcs[ring.front().arc];
            append_point(out, 'M', ring.front().reversed ? first.steps.back().end : first.start);
            for (const DirectedArc& part : ring) append_arc(out, outlines.arcs[part.arc], part.reversed);
            out += 'Z';
        }
        out += "\"/>\n";
    }
    return out + "</g>\n</svg>\n";
}

}  // namespace imgmesh
