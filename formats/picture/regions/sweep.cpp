#include "formats/picture/regions/sweep.h"

#include <algorithm>
#include <cstdint>

#include "libcore/base/error.h"

namespace imgmesh {
namespace {

class Sweep {
  public:
    Sweep(const PictureFacts& facts, const std::function<bool(const PixelRect&)>& look)
        : facts_(facts), look_(look) {}

    void run(std::int64_t most) {
        int side = 2048;
        while (std::int64_t{side} * side > most && side > 1) side /= 2;
        // Squares share fewer blocks of tiled pictures than bands.
        const bool bands = facts_.block_width >= facts_.width && facts_.width <= most;
        const int columns = bands ? facts_.width : side;
        int rows = bands ? std::max(1, side * side / columns) : side;
        if (facts_.block_height > 0 && rows > facts_.block_height) rows -= rows % facts_.block_height;
        for (int y = 0; y < facts_.height; y = next_band(y, rows)) {
            broken_ = false;
            for (int x = 0; x < facts_.width; x += columns)
                if (!part({x, y, std::min(facts_.width, x + columns), std::min(facts_.height, y + rows)}))
                    return;
        }
    }

  private:
    // Of rows that follow each other, those behind a broken one are lost, and each try to read them would
    // begin at the top of their block.
    int next_band(int y, int rows) const {
        const bool lost = broken_ && facts_.access == RegionAccess::kSpool && facts_.holds_all;
        return lost ? (y / facts_.block_height + 1) * facts_.block_height : y + rows;
    }

    // Returns false to end. A part with a broken block is halved, so that what is beside it is looked at.
    bool part(const PixelRect& p) {
        try {
            return look_(p);
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::kBadFile && error.kind() != ErrorKind::kIo) throw;
            broken_ = true;
        }
        if (p.height() > 1 && p.height() > facts_.block_height) {
            const int middle = p.top + p.height() / 2;
            return part({p.left, p.top, p.right, middle}) && part({p.left, middle, p.right, p.bottom});
        }
        if (p.width() > 1 && p.width() > facts_.block_width) {
            const int middle = p.left + p.width() / 2;
            return part({p.left, p.top, middle, p.bottom}) && part({middle, p.top, p.right, p.bottom});
        }
        return true;
    }

    const PictureFacts& facts_;
    const std::function<bool(const PixelRect&)>& look_;
    bool broken_ = false;
};

}  // namespace

void sweep_picture(const PictureFacts& facts, std::int64_t most,
                   const std::function<bool(const PixelRect&)>& look) {
    Sweep(facts, look).run(most);
}

}  // namespace imgmesh
