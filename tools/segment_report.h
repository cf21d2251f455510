// What imgmesh-segment reports about its regions.
#pragma once

#include <string>

#include "libcore/segment/segment.h"
#include "tools/common/tool_main.h"

namespace imgmesh {

std::vector<Vec3f> mean_colors(const std::vector<RegionFacts>& facts);

/// Returns the members of the report that concern the segmentation.
Report segmentation_report(const Segmentation& result, const std::vector<RegionFacts>& facts);

/// Returns the file of --report: schemas/imgmesh-segment.regions.schema.json.
std::string regions_text(const LabelImage& labels, const std::vector<RegionFacts>& facts,
                         const std::string& generator, const std::string& input);

}  // namespace imgmesh
