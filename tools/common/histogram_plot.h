// Histograms as a drawing of boxes and labels, which becomes an SVG or an image.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "formats/picture/image_text.h"
#include "libcore/image/image.h"
#include "libcore/metrics/distribution.h"

namespace imgmesh {

struct HistogramSeries {
    std::size_t name = 0;  ///< index of its name; determines the colour
    Distribution distribution;
};

/// One measure; its series stand side by side in each bin, so all have the same bins.
struct HistogramPanel {
    std::string title;
    std::vector<HistogramSeries> series;
};

struct PlotBox {
    int x, y, width, height;  ///< [pixels], y down
    Vec3f color;              ///< sRGB
};

/// Boxes are drawn in order on white, labels over them.
struct Plot {
    int width = 0;
    int height = 0;
    std::vector<PlotBox> boxes;
    std::vector<TextLabel> labels;
};

/// Draws the names as a legend, then the panels in rows of three. Heights are shares of a series' values, so
/// series of different counts can be compared. A text gives the values outside the bins. At most three names.
Plot histogram_plot(const std::vector<std::string>& names, const std::vector<HistogramPanel>& panels);

/// Returns the drawing as an SVG document.
std::string plot_svg(const Plot& plot);

/// Returns the boxes of the drawing, `scale` times as large, as an RGB image in sRGB, and the labels for it.
Image plot_boxes(const Plot& plot, int scale);
std::vector<TextLabel> plot_labels(const Plot& plot, int scale);

}  // namespace imgmesh
