#include "libcore/mesh/mask_fans.h"

namespace imgmesh {
namespace {

// Whether the pixel is inside, and in no cell with three pixels inside.
bool bare(const Mask& mask, int x, int y) {
    if (!mask.at(x, y)) return false;
    for (int q = 0; q < 4; ++q) {
        int inside = 0;
        for (const int d : {2 * q, 2 * q + 1, (2 * q + 2) % 8})
            inside += mask.at(x + kAround[d].dx, y + kAround[d].dy);
        if (inside >= 2) return false;
    }
    return true;
}

}  // namespace

// A bare pixel has no two bare neighbours at a right angle: their cell would have three pixels inside.
Strip strip_at(const Mask& mask, int x, int y) {
    if (!bare(mask, x, y)) return Strip::kNoStrip;
    if (bare(mask, x - 1, y) || bare(mask, x + 1, y)) return Strip::kAlongX;
    if (bare(mask, x, y - 1) || bare(mask, x, y + 1)) return Strip::kAlongY;
    return Strip::kAlone;
}

}  // namespace imgmesh
