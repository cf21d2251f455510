#include "tools/tiles/tile_pixels.h"

#include <algorithm>

#include "formats/picture/region_source.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

// A tile cannot know whether the alpha of the whole mask is opaque, so a mask that has alpha is its alpha.
Mask mask_in(const Image& picture, double threshold) {
    const auto least = static_cast<float>(threshold);
    return picture.channel("A") >= 0 ? alpha_mask(picture, least) : image_mask(picture, least);
}

// Returns the part of a picture on `whole` that lies on `rect`.
Image cut_out(const Image& picture, const PixelRect& whole, const PixelRect& rect) {
    Image out{{rect.width(), rect.height(), picture.channels, {}},
              picture.channel_names,
              picture.sample_type,
              picture.color_space};
    out.data.reserve(out.sample_count());
    for (int y = rect.top; y < rect.bottom; ++y) {
        const float* const row = picture.pixel(rect.left - whole.left, y - whole.top);
        out.data.insert(out.data.end(), row, row + out.row_size());
    }
    return out;
}

// Returns a mask on `rect` as one on the larger `reach`, with the outermost pixels repeated.
Mask spread(const Mask& mask, const PixelRect& rect, const PixelRect& reach) {
    if (mask.empty()) return {};
    Mask out(GridSize{reach.width(), reach.height()}, 0);
    for (int y = reach.top; y < reach.bottom; ++y)
        for (int x = reach.left; x < reach.right; ++x)
            out.Grid::at(x - reach.left, y - reach.top) =
                mask.at(std::clamp(x, rect.left, rect.right - 1) - rect.left,
                        std::clamp(y, rect.top, rect.bottom - 1) - rect.top);
    return out;
}

}  // namespace

TilePixels::TilePixels(const std::string& picture, const std::string& mask, const ReadImageOptions& read)
    : picture_(std::make_unique<RegionSource>(picture, read)) {
    if (mask.empty()) return;
    mask_ = std::make_unique<RegionSource>(mask, ReadImageOptions{.limits = read.limits});
    const PictureFacts &own = picture_->facts(), &other = mask_->facts();
    if (own.width != other.width || own.height != other.height)
        throw Error(ErrorKind::kBadFile, cat(mask, ": the mask is ", other.width, "x", other.height, ", ",
                                             picture, " is ", own.width, "x", own.height));
}

TilePixels::~TilePixels() = default;

const PictureFacts& TilePixels::facts() const {
    return picture_->facts();
}

void TilePixels::sweep(const std::function<bool(const PixelRect&)>& look) const {
    picture_->sweep(look);
}

PixelPart TilePixels::read(const PixelRect& rect, const MaskChoice& choice) const {
    ReadImage read = picture_->read_region(rect);
    Mask mask = std::move(read.data);
    if (mask_)
        mask = in_both(mask, mask_in(mask_->read(rect), choice.threshold));
    else if (choice.alpha != AlphaUse::kIgnore)
        mask = in_both(mask, alpha_mask(read.image, static_cast<float>(choice.threshold)));
    return {std::move(read.image), std::move(mask)};
}

TilePart TilePixels::read_tile(const TileGrid& grid, const TileName& tile, const MaskChoice& choice) const {
    const PixelRect rect = grid.rect(tile), reach = reach_of(grid, tile);
    try {
        const PixelPart part = read(reach, choice);
        return {cut_out(part.image, reach, rect), tile_mask(part.mask, grid, tile)};
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::kBadFile && error.kind() != ErrorKind::kIo) throw;
    }
    PixelPart part = read(rect, choice);
    return {std::move(part.image), tile_mask(spread(part.mask, rect, reach), grid, tile)};
}

}  // namespace imgmesh
