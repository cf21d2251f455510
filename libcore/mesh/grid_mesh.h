// The dense mesh that the collapse starts from: one vertex for each pixel (paper sec. 3.1), or several where
// a mask pinches or leaves strips.
#pragma once

#include <algorithm>
#include <vector>

#include "libcore/image/image.h"
#include "libcore/image/mask.h"

namespace imgmesh {

/// A W x H grid of pixels as a triangle mesh. Connectivity is implicit: cell (x, y) is the quad of pixels (x,
/// y) to (x+1, y+1), split by one diagonal; vertex (x, y) has the number y * W + x.
///
/// With a mask, cells of four pixels inside have two triangles, cells of three have one. A pixel where the
/// mask pinches is one vertex for every fan of triangles around it. A pixel in no triangle belongs to a strip
/// one pixel wide; it has two vertices (four if it is alone), half a pixel beside it. See mask_fans.h and
/// masked_rings.h. The first of a pixel's vertices has the pixel's number. The others are numbered after
/// those of all pixels. Why: docs/decisions/0005-masked-images.md.
struct GridMesh {
    FeatureImage feature;  ///< at the vertices: `data` goes on with those of `copies`; sides >= 2 but for
                           ///< masks
    float origin_x = 0;    ///< position of vertex (0, 0) [pixels]: 0, or -0.5 where the image's
    float origin_y = 0;    ///< side is one pixel, which then counts as a strip one pixel wide
    Grid<std::uint8_t> diagonal;  ///< (W-1) x (H-1): 1 joins top left to bottom right, 0 the other two

    Mask mask;               ///< empty() for the whole image
    std::vector<Id> copies;  ///< pixels of the split vertices W * H, W * H + 1, ..., ascending

    /// Of a tile of a larger picture (tile_sides.h): the pixels on the rectangle's sides that stay vertices,
    /// at their places, ascending, with the corners; all others there are removed. Empty where sides are
    /// free.
    std::vector<Id> side_vertices;

    bool falling_diagonal(int x, int y) const { return diagonal.at(x, y) != 0; }
    /// Whether a pixel on a side stays at its place.
    bool keeps(Id pixel) const {
        return std::binary_search(side_vertices.begin(), side_vertices.end(), pixel);
    }
    std::size_t vertex_count() const { return feature.pixel_count() + copies.size(); }
    /// Returns the pixel of vertex v.
    Id pixel_of(Id v) const { return v < feature.pixel_count() ? v : copies[v - feature.pixel_count()]; }
};

/// Splits each cell along the diagonal whose ends differ less in feature space (paper sec. 3.1), in a tie
/// from top left to bottom right. Without a mask, a side of one pixel is doubled at -0.5 and +0.5. Takes any
/// size from 1 x 1. mask: empty(), or of the image's size with a pixel inside.
GridMesh grid_mesh(FeatureImage feature, Mask mask = {});

/// Returns a copy smoothed by `passes` of the separable [1 2 1] / 4 filter, borders repeated. Gradients are
/// taken from such a copy, because most of the error of gradient-based quadrics is noise in per-pixel
/// gradients (docs/paper-map.md).
FeatureImage smoothed(FeatureImage image, int passes);

/// Part of an image of features.
struct FeaturePatch {
    FeatureImage image;
    int left = 0, top = 0;  ///< of it in the image

    /// Takes the image's coordinates.
    const float* pixel(int x, int y) const { return image.pixel(x - left, y - top); }
    /// Of the pixel that a vertex of the image's grid mesh stands for.
    const float* of_vertex(const GridMesh& grid, Id v) const {
        const Id at = grid.pixel_of(v), w = static_cast<Id>(grid.feature.width);
        return pixel(static_cast<int>(at % w), static_cast<int>(at / w));
    }
};

/// Returns smoothed() for the pixels in `rect` and, inside the image, for those beside it, computed from the
/// grid's features around them. With a mask the filter's weights outside are zero, so colours outside do not
/// bleed in.
FeaturePatch smoothed_patch(const GridMesh& grid, int passes, const PixelRect& rect);

inline PixelRect whole_rect(const GridMesh& grid) {
    return {0, 0, grid.feature.width, grid.feature.height};
}

}  // namespace imgmesh
