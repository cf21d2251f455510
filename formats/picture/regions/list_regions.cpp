#include <algorithm>
#include <list>
#include <mutex>
#include <utility>

#include "formats/picture/regions/decoded_regions.h"
#include "formats/picture/regions/list_coverage.h"
#include "formats/picture/regions/tile_list.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

// Files that stay open: those around a region are asked for again by its neighbours. Of those that are held
// as a whole, the memory is that of so many.
constexpr std::size_t kOpenFiles = 8;
constexpr std::int64_t kMostWhole = std::int64_t{1} << 24;  // pixels of a file that is read as a whole

// Copies `part` to where it belongs in `out`, at (x, y).
void paste(const ReadImage& part, int x, int y, ReadImage& out) {
    const Image& from = part.image;
    const auto row = static_cast<std::size_t>(from.width) * static_cast<std::size_t>(from.channels);
    if (!part.data.empty() && out.data.empty()) out.data = Mask(out.image, 1);
    for (int j = 0; j < from.height; ++j) {
        std::copy_n(from.pixel(0, j), row, out.image.pixel(x, y + j));
        for (int i = 0; i < from.width && !out.data.empty(); ++i)
            out.data.values[out.data.index(x + i, y + j)] =
                part.data.empty() ? 1 : part.data.values[part.data.index(i, j)];
    }
    out.non_finite += part.non_finite;
}

class ListRegions : public RegionReader {
  public:
    ListRegions(std::string path, TileList list, ReadImageOptions options)
        : path_(std::move(path)), list_(std::move(list)), options_(std::move(options)) {
        read_headers();
        facts_.width = list_.width;
        facts_.height = list_.height;
        facts_.access = RegionAccess::kDirect;
        check_coverage(path_, list_);
    }

    const PictureFacts& facts() const override { return facts_; }
    ColorSpace color_space() const override { return space_; }

    ReadImage read(const PixelRect& region, ColorSpace fitting) const override {
        ReadImage out;
        out.image =
            make_image(region.width(), region.height(), static_cast<int>(facts_.channel_names.size()));
        out.image.channel_names = facts_.channel_names;
        out.image.sample_type = facts_.sample_type;
        out.image.color_space = facts_.fits_colors ? fitting : space_;
        for (const ListedTile& tile : list_.tiles) {
            const PixelRect here{std::max(region.left, tile.x), std::max(region.top, tile.y),
                                 std::min(region.right, tile.x + tile.width),
                                 std::min(region.bottom, tile.y + tile.height)};
            if (here.left >= here.right || here.top >= here.bottom) continue;
            const std::shared_ptr<const RegionReader> reader = opened(tile, fitting);
            const int dx = tile.from_x - tile.x, dy = tile.from_y - tile.y;
            const ReadImage part =
                reader->read({here.left + dx, here.top + dy, here.right + dx, here.bottom + dy}, fitting);
            if (part.image.channel_names != facts_.channel_names ||
                part.image.sample_type != facts_.sample_type ||
                part.image.color_space != out.image.color_space)
                throw Error(ErrorKind::kBadFile,
                            cat(tile.path, ": has other channels, samples or colours than ", first_,
                                ", with which it is one picture"));
            paste(part, here.left - region.left, here.top - region.top, out);
        }
        if (std::ranges::count(out.data.values, 0) == 0) out.data = Mask();
        return out;
    }

    std::uint64_t read_bytes(int width, int height) const override {
        return 2 * static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) *
                   (sizeof(float) * facts_.channel_names.size() + 1) +
               kOpenFiles * file_bytes_;
    }

  private:
    // Files that cannot be read are errors where they are needed.
    void read_headers() {
        std::string reason;
        int width = 0, height = 0;
        for (ListedTile& tile : list_.tiles) {
            const bool sized = tile.width > 0 && tile.height > 0;
            if (!sized || first_.empty()) try {
                    read_header(tile);
                } catch (const Error& error) {
                    if (reason.empty()) reason = error.what();
                }
            width = std::max(width, tile.x + tile.width);
            height = std::max(height, tile.y + tile.height);
        }
        if (first_.empty())
            throw Error(ErrorKind::kBadFile, cat(path_, ": none of its files can be read: ", reason));
        if (list_.width == 0) list_.width = width;
        if (list_.height == 0) list_.height = height;
        guess_sizes(list_);
    }

    void read_header(ListedTile& tile) {
        const std::unique_ptr<RegionReader> reader = open_picture_regions(tile.path, options_);
        const PictureFacts& facts = reader->facts();
        if (tile.width == 0) tile.width = facts.width;
        if (tile.height == 0) tile.height = facts.height;
        file_bytes_ = std::max(file_bytes_, reader->read_bytes(1, 1));
        if (!first_.empty()) return;
        const auto space_for = [&](ColorSpace fitting) {
            ReadImageOptions options = options_;
            options.fitting_space = fitting;
            return open_picture_regions(tile.path, options)->color_space();
        };
        check_whole(tile, facts);
        facts_ = facts;
        facts_.fits_colors = space_for(ColorSpace::kDisplayP3) != space_for(ColorSpace::kAdobeRgb);
        facts_.why.clear();
        facts_.holds_all = false;
        space_ = facts_.fits_colors ? ColorSpace::kSrgb : reader->color_space();
        first_ = tile.path;
    }

    static void check_whole(const ListedTile& tile, const PictureFacts& facts) {
        if (facts.holds_all && std::int64_t{facts.width} * facts.height > kMostWhole)
            throw Error(ErrorKind::kUnsupported,
                        cat(tile.path, ": ", facts.why, " of ", facts.width, "x", facts.height,
                            " pixels, and files of a list that are read as a whole have at most ", kMostWhole,
                            "; a tiled TIFF is read by parts"));
    }

    std::shared_ptr<const RegionReader> opened(const ListedTile& tile, ColorSpace fitting) const {
        {
            const std::lock_guard lock(mutex_);
            for (auto it = open_.begin(); it != open_.end(); ++it)
                if (it->path == tile.path && it->fitting == fitting) {
                    open_.splice(open_.begin(), open_, it);
                    return open_.front().reader;
                }
        }
        ReadImageOptions options = options_;
        if (facts_.fits_colors) options.fitting_space = fitting;
        std::shared_ptr<const RegionReader> reader = open_picture_regions(tile.path, options);
        const PictureFacts& facts = reader->facts();
        if (tile.exact ? facts.width != tile.width || facts.height != tile.height
                       : facts.width - tile.from_x < tile.width || facts.height - tile.from_y < tile.height)
            throw Error(ErrorKind::kBadFile,
                        cat(tile.path, ": the file has ", facts.width, "x", facts.height,
                            " pixels, expected ", tile.exact ? "" : "at least ", tile.width + tile.from_x,
                            "x", tile.height + tile.from_y, " as ", path_, " has it"));
        check_whole(tile, facts);
        const std::lock_guard lock(mutex_);
        open_.push_front({tile.path, fitting, reader});
        if (open_.size() > kOpenFiles) open_.pop_back();
        return reader;
    }

    struct Open {
        std::string path;
        ColorSpace fitting;
        std::shared_ptr<const RegionReader> reader;
    };

    std::string path_;
    TileList list_;
    ReadImageOptions options_;
    PictureFacts facts_;
    ColorSpace space_ = ColorSpace::kSrgb;
    std::string first_;  ///< the file that the facts are from
    std::uint64_t file_bytes_ = 0;
    mutable std::mutex mutex_;
    mutable std::list<Open> open_;  ///< the latest first
};

}  // namespace

std::unique_ptr<RegionReader> open_list(const std::string& path, TileList list,
                                        const ReadImageOptions& options) {
    return std::make_unique<ListRegions>(path, std::move(list), options);
}

}  // namespace imgmesh
