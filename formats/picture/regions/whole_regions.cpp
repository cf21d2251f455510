// A picture that is held as a whole, and cut.
#include <algorithm>

#include "formats/picture/regions/region_reader.h"

namespace imgmesh {
namespace {

// Image and Mask hold their pixels alike.
template <typename Pixels, typename Samples>
void copy_rows(const Pixels& from, const PixelRect& region, std::size_t channels, const Samples& samples,
               Samples& out) {
    out.clear();
    for (int y = region.top; y < region.bottom; ++y) {
        const auto row = samples.begin() + static_cast<std::ptrdiff_t>(from.index(region.left, y) * channels);
        out.insert(out.end(), row,
                   row + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(region.width()) * channels));
    }
}

class WholeRegions : public RegionReader {
  public:
    WholeRegions(const std::string& path, const ReadImageOptions& options)
        : picture_(read_image_file(path, options)) {
        const Image& image = picture_.image;
        facts_.width = image.width;
        facts_.height = image.height;
        facts_.channel_names = image.channel_names;
        facts_.sample_type = image.sample_type;
        facts_.holds_all = true;
        facts_.why = "it is in a format that is only read as a whole";
        facts_.warnings = picture_.warnings;
    }

    const PictureFacts& facts() const override { return facts_; }
    ColorSpace color_space() const override { return picture_.image.color_space; }

    ReadImage read(const PixelRect& region, ColorSpace) const override {
        const Image& image = picture_.image;
        ReadImage out;
        out.image.width = region.width();
        out.image.height = region.height();
        out.image.channels = image.channels;
        out.image.channel_names = image.channel_names;
        out.image.sample_type = image.sample_type;
        out.image.color_space = image.color_space;
        copy_rows(image, region, static_cast<std::size_t>(image.channels), image.data, out.image.data);
        if (!picture_.data.empty()) {
            out.data = Mask(out.image, 0);
            copy_rows(picture_.data, region, 1, picture_.data.values, out.data.values);
            if (std::ranges::count(out.data.values, 0) == 0) out.data = Mask();
        }
        return out;
    }

    std::uint64_t read_bytes(int width, int height) const override {
        return (picture_.image.data.size() + static_cast<std::size_t>(width) *
                                                 static_cast<std::size_t>(height) *
                                                 static_cast<std::size_t>(picture_.image.channels)) *
                   sizeof(float) +
               picture_.data.values.size();
    }

  private:
    ReadImage picture_;
    PictureFacts facts_;
};

}  // namespace

std::unique_ptr<RegionReader> open_whole(const std::string& path, const ReadImageOptions& options) {
    return std::make_unique<WholeRegions>(path, options);
}

}  // namespace imgmesh
