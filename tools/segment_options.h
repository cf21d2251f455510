// The options of imgmesh-segment.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "formats/container/container.h"
#include "formats/picture/image_io.h"
#include "libcore/segment/region_outlines.h"
#include "libcore/segment/seeds.h"

namespace CLI {
class App;
}

namespace imgmesh {

struct SegmentOptions {
    std::string input, output;
    SegmentParams params;
    std::optional<double> threshold, compactness;
    std::optional<DistanceRule> distance;
    std::optional<SegmentQuality> quality;
    int level = 0;
    std::vector<Seed> seeds;
    std::string image, outlines, flat, colors, svg, ucm, report, mesh, mask;
    double svg_tolerance = kMostOutlineTolerance;
    ReadImageOptions read;
    ContainerLimits limits;
    bool strict = false;
};

void add_segment_options(CLI::App& app, SegmentOptions& options);

/// Returns the parameters with the usual values where none are given.
SegmentParams params_of(const SegmentOptions& options);

/// Returns all files that a run writes.
std::vector<std::string> outputs_of(const SegmentOptions& options);

/// Throws Error(kBadArgument) for mistakes that can be found before the container is read.
void check_segment_options(const SegmentOptions& options);

}  // namespace imgmesh
