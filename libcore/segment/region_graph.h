// Cells and their borders as a graph: what distances between regions are computed from.
#pragma once

#include <vector>

#include "libcore/image/image.h"
#include "libcore/segment/cells.h"

namespace imgmesh {

/// Sums over the pixels of a region; those of two regions add up.
struct RegionSums {
    double pixels = 0;
    Vec3d color = Vec3d::Zero();           ///< of L*u*v*
    Vec3d square = Vec3d::Zero();          ///< of its squares, channel by channel
    double weight = 0;                     ///< of the least of the three weights of each pixel
    Vec3d weighted_color = Vec3d::Zero();  ///< of weight times L*u*v*
    Vec2d place = Vec2d::Zero();           ///< of x, y [pixels]

    RegionSums& operator+=(const RegionSums& other);
    /// The paper's colour of a patch (sec. 4.1): the mean weighted by the least weight. Where all weights are
    /// zero, as in splinters along a patch's rim, the plain mean.
    Vec3d paper_color() const { return weight > 0 ? Vec3d(weighted_color / weight) : mean_color(); }
    Vec3d mean_color() const { return color / pixels; }
    Vec2d mean_place() const { return place / pixels; }
    Vec3d variance() const;  ///< of each channel
};

/// Where two regions touch; borders add up.
struct Border {
    Id a = kNone;  ///< the lower of the two
    Id b = kNone;
    double length = 0;    ///< pairs of 4-neighbours across it
    double contrast = 0;  ///< sum of the pairs' contrasts

    double mean_contrast() const { return contrast / length; }
};

struct RegionGraph {
    std::vector<RegionSums> regions;
    std::vector<Border> borders;  ///< sorted by (a, b)
};

/// The contrasts of pixel pairs: those of (x, y) with its right and with its lower neighbour, each of size
/// width * height (what has no such neighbour is not read), or empty: all zero.
struct PairContrasts {
    std::vector<float> right;
    std::vector<float> down;
};

/// Sums of every cell and border. image: L*u*v*, of the cells' size.
RegionGraph region_graph(const Cells& cells, const PixelMap& map, const FeatureImage& picture,
                         const PairContrasts& contrasts);

}  // namespace imgmesh
