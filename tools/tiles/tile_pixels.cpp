#include "tools/tiles/tile_pixels.h"

#include "formats/picture/region_source.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

// A tile cannot know whether the alpha of the whole mask is opaque, so a mask that has alpha is its alpha.
Mask mask_in(const Image& picture, double threshold) {
    const auto least = static_cast<float>(threshold);
    return picture.channel("A") >= 0 ? alpha_mask(picture, least) : image_mask(picture, least);
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

}  // namespace imgmesh
