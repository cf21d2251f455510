// Cells and their borders as a graph, with the sums from which distances between regions are computed.
#pragma once

#include <vector>

#include "libcore/image/image.h"
#include "libcore/segment/cells.h"

namespace imgmesh {

/// Sums over the pixels of a region. The sums of two regions add up.
struct RegionSums {
    double pixels = 0;
    Vec3d color = Vec3d::Zero();           ///< sum of L*u*v*
    Vec3d square = Vec3d::Zero();          ///< sum of the squares of L*, u* and v*
    double weight = 0;                     ///< sum of the smallest of each pixel's three weights
    Vec3d weighted_color = Vec3d::Zero();  ///< sum of that weight times L*u*v*
    Vec2d place = Vec2d::Zero();           ///< sum of x and of y [pixels]

    RegionSums& operator+=(const RegionSums& other);
    /// The paper's colour of a patch (sec. 4.1): the mean weighted by each pixel's smallest weight. If all
    /// weights are zero, as in splinters along a patch's rim, the unweighted mean.
    Vec3d paper_color() const { return weight > 0 ? Vec3d(weighted_color / weight) : mean_color(); }
    Vec3d mean_color() const { return color / pixels; }
    Vec2d mean_place() const { return place / pixels; }
    Vec3d variance() const;  ///< of each channel
};

/// The line along which two regions touch. The borders of merged regions add up.
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

/// The contrasts of (x, y) with its right and with its lower neighbour. Each vector has size width * height,
/// and pixels without such a neighbour are not read. An empty vector means that all contrasts are zero.
struct PairContrasts {
    std::vector<float> right;
    std::vector<float> down;
};

/// Two neighbouring pixels in different regions.
struct Crossing {
    Id a = kNone;  ///< the lower of the two
    Id b = kNone;
    float contrast = 0;
};

/// Adds the pairs of neighbours in different regions whose first pixel, the left or the upper one, is in
/// `own`, in the order of these pixels. Pixels that are kNone are in no region.
void add_crossings(std::vector<Crossing>& crossings, const Grid<Id>& regions, const PairContrasts& contrasts,
                   const PixelRect& own);

/// Returns the borders that consist of `crossings`, sorted; contrasts add up in the order given.
std::vector<Border> borders_of(std::vector<Crossing> crossings);

/// Adds up parts of the same border, in the order given. Returns them sorted by (a, b).
std::vector<Border> joined_borders(std::vector<Border> parts);

/// Returns the sums of every cell.
std::vector<RegionSums> region_sums(const Grid<Id>& cells, std::size_t count, const PixelMap& map,
                                    const FeatureImage& image);

/// Returns the sums of every cell and every border. The image is L*u*v*, of the cells' size.
RegionGraph region_graph(const Cells& cells, const PixelMap& map, const FeatureImage& image,
                         const PairContrasts& contrasts);

}  // namespace imgmesh
