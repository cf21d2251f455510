// What imgmesh-compare has found, as members of the report, as text and as histograms.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "libcore/metrics/compare_channels.h"
#include "libcore/metrics/compare_images.h"
#include "libcore/metrics/metrics.h"
#include "libcore/metrics/quality_distributions.h"
#include "tools/common/histogram_plot.h"
#include "tools/common/tool_main.h"

namespace imgmesh {

/// All measures of one level of a container.
struct LevelQuality {
    std::size_t vertices = 0;
    std::size_t faces = 0;
    MeshDistributions mesh;
    MapDistributions map;
    MapQuality map_quality;
};

Report distribution_report(const Distribution& d);
Report quality_report(const LevelQuality& quality);
/// luv, ciede2000: the distributions of the pixels' errors.
Report difference_report(const ImageDifference& difference, const Distribution& luv,
                         const Distribution& ciede2000);

/// Returns the measures of `qualities` as panels with one series each. names: for each quality an index into
/// the plot's names.
std::vector<HistogramPanel> quality_panels(const std::vector<LevelQuality>& qualities,
                                           const std::vector<std::size_t>& names);

void print_comparison(const Report& report, std::ostream& out);
/// The same in a few words.
std::string comparison_line(const Report& report);

}  // namespace imgmesh
