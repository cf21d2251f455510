#include "formats/picture/region_source.h"

#include <algorithm>
#include <filesystem>
#include <mutex>
#include <optional>
#include <span>

#include "formats/files/random_file.h"
#include "formats/picture/color/profile_convert.h"
#include "formats/picture/decode/picture_probe.h"
#include "formats/picture/regions/decoded_regions.h"
#include "formats/picture/regions/sweep.h"
#include "formats/picture/regions/tile_list.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

// The header is the first chunk, and its last byte says it.
bool is_interlaced_png(std::span<const std::uint8_t> start) {
    constexpr std::size_t kInterlaced = 28;
    return start.size() > kInterlaced && start[kInterlaced] == 1;
}

// Returns the list of a picture of many files; nothing for a picture file.
std::optional<TileList> list_of(const std::string& path, const ReadImageOptions& options) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) return list_folder(path, options);
    if (is_vrt(path)) return read_vrt(path);
    if (is_json_list(path)) return read_json_list(path);
    return {};
}

std::unique_ptr<RegionReader> open_regions(const std::string& path, const ReadImageOptions& options) {
    if (options.non_finite == NonFinite::kNearest)
        throw Error(ErrorKind::kBadArgument,
                    cat(path,
                        ": samples that are not finite cannot get the value of the nearest pixel where "
                        "a picture is read by parts, expected that they are refused or become 0"));
    if (std::optional<TileList> list = list_of(path, options))
        return open_list(path, *std::move(list), options);
    return open_picture_regions(path, options);
}

std::string span_text(const PixelRect& r) {
    return cat("columns ", r.left, " to ", r.right - 1, ", rows ", r.top, " to ", r.bottom - 1);
}

}  // namespace

std::vector<std::string> picture_files(const std::string& path, const ReadImageOptions& options) {
    std::error_code ignored;
    std::vector<std::string> files;
    if (!std::filesystem::is_directory(path, ignored)) files.push_back(path);
    if (const std::optional<TileList> list = list_of(path, options))
        for (const ListedTile& tile : list->tiles) files.push_back(tile.path);
    return files;
}

std::unique_ptr<RegionReader> open_picture_regions(const std::string& path, const ReadImageOptions& options) {
    constexpr std::size_t kStart = std::size_t{1} << 16;  // far more than signatures need
    const std::vector<std::uint8_t> start = RandomFile(path).bytes_at(0, kStart);
    switch (probe_picture(path, start).format) {
        case PictureFormat::kExr:
            return open_exr_regions(path, options);
        case PictureFormat::kPnm:
            return open_pnm_regions(path, options);
        case PictureFormat::kTiff:
            return open_tiff_regions(path, options);
        case PictureFormat::kJpeg:
            return open_jpeg_regions(path, options);
        case PictureFormat::kPng:
            return is_interlaced_png(start) ? open_whole(path, options) : open_png_regions(path, options);
        default:
            return open_whole(path, options);
    }
}

struct RegionSource::State {
    std::string path;
    ReadImageOptions options;
    std::unique_ptr<RegionReader> reader;
    std::once_flag once;
    ColorSpace fitted = ColorSpace::kSrgb;

    ReadImage read(const PixelRect& region, ColorSpace fitting) const {
        try {
            return reader->read(region, fitting);
        } catch (const Error& error) {
            throw Error(error.kind(), cat(error.what(), " (read for ", span_text(region), ")"));
        }
    }

    ColorSpace narrowest() const {
        OutsideGamut counts;
        sweep_picture(reader->facts(), options.limits.max_pixels, [&](const PixelRect& part) {
            count_outside(read(part, ColorSpace::kLinear).image, counts);
            return true;
        });
        return narrowest_space(counts);
    }

    ColorSpace color_space() {
        if (!reader->facts().fits_colors) return reader->color_space();
        std::call_once(once, [&] { fitted = options.fitting_space ? *options.fitting_space : narrowest(); });
        return fitted;
    }
};

RegionSource::RegionSource(const std::string& path, const ReadImageOptions& options)
    : state_(std::make_unique<State>()) {
    state_->path = path;
    state_->options = options;
    state_->reader = open_regions(path, options);
}

RegionSource::~RegionSource() = default;

const PictureFacts& RegionSource::facts() const {
    return state_->reader->facts();
}

void RegionSource::sweep(const std::function<bool(const PixelRect&)>& look) const {
    sweep_picture(facts(), state_->options.limits.max_pixels, look);
}

ColorSpace RegionSource::color_space() const {
    return state_->color_space();
}

Image RegionSource::read(const PixelRect& region) const {
    return read_region(region).image;
}

ReadImage RegionSource::read_region(const PixelRect& region) const {
    const PictureFacts& f = facts();
    if (region.left < 0 || region.top < 0 || region.left >= region.right || region.top >= region.bottom ||
        region.right > f.width || region.bottom > f.height)
        throw Error(ErrorKind::kBadArgument,
                    cat(state_->path, ": ", span_text(region), " are not inside the picture of ", f.width,
                        "x", f.height, " pixels"));
    check_size(state_->path, region.width(), region.height(),
               std::max<std::int64_t>(1, static_cast<std::int64_t>(f.channel_names.size())),
               state_->options.limits);
    return state_->read(region, color_space());
}

std::uint64_t RegionSource::read_bytes(int width, int height) const {
    return state_->reader->read_bytes(width, height);
}

}  // namespace imgmesh
