// Places of vertices in whole numbers, so that every test of them is exact on every machine.
#pragma once

#include <cstdint>

namespace imgmesh {

/// The optimiser's unit of places is the finest step of positions, kPositionStep. Coded meshes have places in
/// quarter pixels outside it.
inline constexpr int kPlacesPerPixel = 32;

/// x to the right, y down, each below 2^21 units.
struct Place {
    std::int32_t x = 0, y = 0;

    bool operator==(const Place&) const = default;
};

/// Returns twice the area of (a, b, c): positive if it runs counter-clockwise on screen.
inline std::int64_t area2(const Place& a, const Place& b, const Place& c) {
    return std::int64_t{b.y - a.y} * (c.x - a.x) - std::int64_t{b.x - a.x} * (c.y - a.y);
}

}  // namespace imgmesh
