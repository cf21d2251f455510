#include "libcore/segment/segment_rules.h"

#include <cmath>

#include "libcore/base/error.h"

namespace imgmesh {
namespace {

[[noreturn]] void refuse(const std::string& text) {
    throw Error(ErrorKind::kBadArgument, text);
}

}  // namespace

void check_rules(const SegmentParams& params) {
    if (!(params.threshold > 0 && std::isfinite(params.threshold)))
        refuse(cat("threshold is ", params.threshold, ", expected above 0"));
    if (params.segments && params.superpixels) refuse("segments and superpixels exclude each other");
    if (params.clearest && (params.segments || params.superpixels))
        refuse("the clearest regions, and a number of segments or superpixels exclude each other");
    if (params.segments && *params.segments < 1)
        refuse(cat("segments is ", *params.segments, ", expected at least 1"));
    if (params.superpixels && *params.superpixels < 1)
        refuse(cat("superpixels is ", *params.superpixels, ", expected at least 1"));
    if (!(params.compactness >= 0 && std::isfinite(params.compactness)))
        refuse(cat("compactness is ", params.compactness, ", expected at least 0"));
    if (params.min_size < 1) refuse(cat("the least size is ", params.min_size, ", expected at least 1"));
}

void check_picture(const Level& level, const FeatureImage& image) {
    if (image.width != level.map.width || image.height != level.map.height)
        refuse(cat("the image has ", image.width, "x", image.height, " pixels, the container ",
                   level.map.width, "x", level.map.height));
    if (image.channels != 3)
        throw Error(ErrorKind::kUnsupported,
                    cat("the image has ", image.channels, " channels, expected L*, u*, v*"));
}

std::size_t wanted_merges(const Hierarchy& hierarchy, const SegmentParams& params, std::string_view source,
                          std::string& missed) {
    if (params.segments) return merges_to_count(hierarchy, *params.segments, source, missed);
    if (params.clearest)
        return clearest_merges(hierarchy, params.threshold / kClearestRange,
                               params.threshold * kClearestRange);
    return merges_below(hierarchy, params.threshold);
}

}  // namespace imgmesh
