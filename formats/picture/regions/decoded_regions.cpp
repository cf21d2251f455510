#include "formats/picture/regions/decoded_regions.h"

#include <algorithm>
#include <mutex>
#include <utility>

#include "formats/picture/decode/finish_picture.h"
#include "formats/picture/decode/orientation.h"
#include "formats/picture/decode/picture_probe.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

// With this side all products of sizes and channels are far below 2^63.
constexpr int kMaxSide = 1000000;

class DecodedRegions : public RegionReader {
  public:
    DecodedRegions(std::string path, ReadImageOptions options, PictureHeader header,
                   std::function<std::unique_ptr<RegionDecoder>()> open)
        : path_(std::move(path)),
          options_(std::move(options)),
          header_(std::move(header)),
          open_(std::move(open)),
          orientation_(orientation_of(header_.zero_pixel.orientation)) {
        const ReadImage zero = finished_zero(options_.fitting_space);
        facts_.width = orientation_.exchange ? header_.height : header_.width;
        facts_.height = orientation_.exchange ? header_.width : header_.height;
        facts_.channel_names = zero.image.channel_names;
        facts_.sample_type = zero.image.sample_type;
        facts_.access = header_.access;
        facts_.why = header_.why;
        facts_.block_width = orientation_.exchange ? header_.block_height : header_.block_width;
        facts_.block_height = orientation_.exchange ? header_.block_width : header_.block_height;
        facts_.warnings = zero.warnings;
        space_ = zero.image.color_space;
        // A space that follows the wish is one that integers of a foreign profile are converted to.
        foreign_ = finished_zero(ColorSpace::kDisplayP3).image.color_space !=
                   finished_zero(ColorSpace::kAdobeRgb).image.color_space;
        if (facts_.access == RegionAccess::kWhole) {
            open_ = {};
            check_size(path_, facts_.width, facts_.height, header_.zero_pixel.image.channels,
                       options_.limits);
        }
        facts_.holds_all = !open_ || header_.by_rows;
        facts_.fits_colors = foreign_ && open_;
    }

    const PictureFacts& facts() const override { return facts_; }
    ColorSpace color_space() const override {
        return foreign_ && !facts_.fits_colors ? whole().color_space() : space_;
    }

    ReadImage read(const PixelRect& region, ColorSpace fitting) const override {
        if (!open_ || goes_back(region)) return whole().read(region, fitting);
        ReadImageOptions options = options_;
        if (facts_.fits_colors) options.fitting_space = fitting;
        ReadImage out = finish_picture(path_, decode(region), options);
        const ColorSpace expected = facts_.fits_colors ? fitting : space_;
        if (out.image.channel_names != facts_.channel_names || out.image.sample_type != facts_.sample_type ||
            out.image.color_space != expected)
            throw Error(ErrorKind::kBadFile,
                        cat(path_,
                            ": channels or colours of a part of the picture cannot be used, so that it "
                            "would differ from the rest",
                            out.warnings.empty() ? "" : ": " + out.warnings.back()));
        return out;
    }

    std::uint64_t read_bytes(int width, int height) const override {
        // Samples as stored, a copy while colours are converted or turned, and the mask.
        const std::uint64_t channels = std::max<std::uint64_t>(
            facts_.channel_names.size(), static_cast<std::uint64_t>(header_.zero_pixel.image.channels));
        const std::uint64_t pixel = 2 * sizeof(float) * channels + 2;
        return static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) * pixel +
               header_.decode_bytes;
    }

  private:
    ReadImage finished_zero(std::optional<ColorSpace> fitting) const {
        ReadImageOptions options = options_;
        options.fitting_space = fitting;
        return finish_picture(path_, header_.zero_pixel, options);
    }

    DecodedPicture decode(const PixelRect& region) const {
        std::unique_ptr<RegionDecoder> decoder;
        {
            const std::lock_guard lock(mutex_);
            if (!idle_.empty()) {
                decoder = std::move(idle_.back());
                idle_.pop_back();
            }
        }
        if (!decoder) decoder = open_();
        DecodedPicture out =
            decoder->decode(stored_rect(region, orientation_, header_.width, header_.height));
        const std::lock_guard lock(mutex_);  // one that has thrown is not used again
        idle_.push_back(std::move(decoder));
        return out;
    }

    // From the top on, a large picture of rows is read without holding it.
    bool goes_back(const PixelRect& region) const {
        constexpr std::int64_t kLarge = std::int64_t{1} << 24;  // pixels
        if (!header_.by_rows) return false;
        if (std::int64_t{facts_.width} * facts_.height <= kLarge && can_hold()) return true;
        const PixelRect stored = stored_rect(region, orientation_, header_.width, header_.height);
        const std::lock_guard lock(mutex_);
        const bool back = stored.top < next_row_;
        next_row_ = stored.bottom;
        return back && can_hold();
    }
    bool can_hold() const {
        try {
            check_size(path_, facts_.width, facts_.height, header_.zero_pixel.image.channels,
                       options_.limits);
        } catch (const Error&) {
            return false;
        }
        return true;
    }

    const RegionReader& whole() const {
        const std::lock_guard lock(mutex_);
        if (!whole_) whole_ = open_whole(path_, options_);
        return *whole_;
    }

    std::string path_;
    ReadImageOptions options_;
    PictureHeader header_;
    std::function<std::unique_ptr<RegionDecoder>()> open_;
    Orientation orientation_;
    PictureFacts facts_;
    ColorSpace space_ = ColorSpace::kSrgb;
    bool foreign_ = false;  ///< integers of a profile that is none of ours
    mutable std::mutex mutex_;
    mutable std::vector<std::unique_ptr<RegionDecoder>> idle_;
    mutable std::unique_ptr<RegionReader> whole_;
    mutable int next_row_ = 0;  ///< behind the latest region, as stored
};

}  // namespace

ImageLimits source_limits(const ReadImageOptions& options, std::uint64_t file_bytes) {
    ImageLimits limits = options.limits;
    limits.max_side = kMaxSide;
    limits.max_memory = std::numeric_limits<std::uint64_t>::max();
    limits.max_pixels = std::int64_t{kMaxSide} * kMaxSide;
    return limits_for_bytes(limits, file_bytes);
}

std::unique_ptr<RegionReader> open_decoded(const std::string& path, const ReadImageOptions& options,
                                           PictureHeader header,
                                           std::function<std::unique_ptr<RegionDecoder>()> open) {
    return std::make_unique<DecodedRegions>(path, options, std::move(header), std::move(open));
}

}  // namespace imgmesh
