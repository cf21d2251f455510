// What two neighbouring tiles must have alike on the side that they share. Internal to the validator.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

/// A side of a tile: its vertices, and where on it the pixels of its line lie.
struct TileSide {
    struct Vertex {
        float at;                     ///< along the line [units]
        std::vector<float> features;  ///< as stored
        bool operator==(const Vertex&) const = default;
    };
    /// A pixel's place: one or two vertices of the line and their weights. Without any for a pixel outside
    /// the mask.
    struct Pixel {
        std::array<float, 2> at = {}, weight = {};
        bool off = false;  ///< not on the line
        bool operator==(const Pixel&) const = default;
    };
    std::vector<Vertex> vertices;  ///< in their order along the line
    std::vector<Pixel> pixels;
    bool has_mask = false;  ///< the tile
};

enum class SideOf { kLeft, kTop, kRight, kBottom };

/// Returns a side of level 0 of `image`. The mesh reaches from 0 to `width` - 1 and `height` - 1 of its size
/// where it has a neighbour.
TileSide tile_side(const MeshImage& image, SideOf side);

/// Returns how two sides differ, as "12 vertices and 13"; "" if they are alike to the bit. Where one of them
/// has a mask, only what both have on faces at the line counts.
std::string vertex_difference(const TileSide& a, const TileSide& b);
std::string pixel_difference(const TileSide& a, const TileSide& b);

}  // namespace imgmesh
