// What viewers of 3D Tiles load of a tile: its mesh without a pixel map, and skirts.
#pragma once

#include <string>

#include "libcore/mesh/mesh_image.h"
#include "libcore/tiles/tile_grid.h"

namespace imgmesh {

/// A skirt reaches so far outward of a side that the tile shares, and so far behind the picture there, in
/// units of 2^level pixels. Whole units cost Draco's grid no bit.
inline constexpr float kSkirtWidth = 4, kSkirtDepth = 1;

/// How far the skirts of a tile reach outward [units]; 0 where it has no neighbour, and no farther than that
/// one does.
struct SkirtReach {
    float left = 0, top = 0, right = 0, bottom = 0;
};
SkirtReach skirt_reach(const TileGrid& grid, const TileName& tile);

/// Writes a .glb with the nodes "tile" and, if the tile has neighbours, "skirt", both compressed by Draco and
/// unlit; nothing else is needed to show it. x is to the right, y up, z towards the viewer, in pixels of
/// level 0 from the centre of the tile's top-left pixel.
///
/// A skirt is a strip outward from each side that the tile shares with another, in the side's colours,
/// sloping behind the picture. Neighbouring sides lie on one line, but a viewer rounds their corners
/// differently, most of all where one has corners between those of the other; the skirts show there instead
/// of what is behind.
///
/// mesh    of the tile as its container has it: from that pixel, in units of 2^level pixels
/// source  of the MeshImage that holds it; only the colour and a channel A are written
///
/// The file appears whole or not at all; an older one is replaced. Takes O(vertices + faces) time. Throws
/// Error: kInternal for a mesh that a container could not hold; kIo if it cannot be written.
void write_tile_view(const BaseMesh& mesh, const SourceInfo& source, const TileGrid& grid,
                     const TileName& tile, const std::string& generator, const std::string& path);

}  // namespace imgmesh
