#include "formats/picture/decode/orientation.h"

#include <array>
#include <utility>

namespace imgmesh {

Orientation orientation_of(int number) {
    constexpr std::array<Orientation, 9> kOrientations = {{{false, false, false},  // 0: none is given
                                                           {false, false, false},
                                                           {false, true, false},
                                                           {false, true, true},
                                                           {false, false, true},
                                                           {true, false, false},
                                                           {true, false, true},
                                                           {true, true, true},
                                                           {true, true, false}}};
    const bool known = number >= 0 && static_cast<std::size_t>(number) < kOrientations.size();
    return known ? kOrientations[static_cast<std::size_t>(number)] : Orientation();
}

PixelRect stored_rect(const PixelRect& displayed, const Orientation& orientation, int width, int height) {
    PixelRect out = displayed;
    if (orientation.exchange) {
        std::swap(out.left, out.top);
        std::swap(out.right, out.bottom);
    }
    if (orientation.backwards_x) {
        std::swap(out.left, out.right);
        out.left = width - out.left;
        out.right = width - out.right;
    }
    if (orientation.backwards_y) {
        std::swap(out.top, out.bottom);
        out.top = height - out.top;
        out.bottom = height - out.bottom;
    }
    return out;
}

}  // namespace imgmesh
