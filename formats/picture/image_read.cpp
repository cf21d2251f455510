// read_image(): reads the file's bytes, probes them, runs one of the decoders, and does what all images need.
#include <algorithm>
#include <array>
#include <cmath>

#include "formats/files/atomic_file.h"
#include "formats/picture/color/primaries.h"
#include "formats/picture/decode/keep_channels.h"
#include "formats/picture/decode/nodata.h"
#include "formats/picture/decode/non_finite.h"
#include "formats/picture/decode/picture_decoders.h"
#include "formats/picture/image_io.h"
#include "libcore/base/error.h"
#include "libcore/image/feature_space.h"

namespace imgmesh {
namespace {

// Above any image within the default limits, and far below the memory of a machine.
constexpr std::uint64_t kMaxFileBytes = std::uint64_t{8} << 30;

// Where a displayed pixel is stored, as bits (EXIF 2.3, tag Orientation): first the axes are exchanged, then
// each may be reversed.
struct Orientation {
    bool exchange, backwards_x, backwards_y;
};
constexpr std::array<Orientation, 9> kOrientations = {{{false, false, false},  // 0: none is given
                                                       {false, false, false},
                                                       {false, true, false},
                                                       {false, true, true},
                                                       {false, false, true},
                                                       {true, false, false},
                                                       {true, false, true},
                                                       {true, true, true},
                                                       {true, true, false}}};

void copy_pixel(const Image& from, std::size_t i, Image& to, std::size_t j) {
    std::copy_n(from.pixel(i), from.channels, to.pixel(j));
}
void copy_pixel(const Mask& from, std::size_t i, Mask& to, std::size_t j) {
    to.values[j] = from.values[i];
}

template <typename Pixels>
Pixels displayed(Pixels stored, int orientation) {
    if (orientation < 2 || orientation > 8) return stored;
    const Orientation o = kOrientations[static_cast<std::size_t>(orientation)];
    Pixels out = stored;
    if (o.exchange) std::swap(out.width, out.height);
    for (int y = 0; y < out.height; ++y) {
        for (int x = 0; x < out.width; ++x) {
            int from_x = o.exchange ? y : x, from_y = o.exchange ? x : y;
            if (o.backwards_x) from_x = stored.width - 1 - from_x;
            if (o.backwards_y) from_y = stored.height - 1 - from_y;
            copy_pixel(stored, stored.index(from_x, from_y), out, out.index(x, y));
        }
    }
    return out;
}

// Where alpha is zero, the colour is kept: it is light that covers nothing.
void divide_alpha_out(Image& image) {
    const int alpha = image.channel("A");
    if (alpha < 0) return;
    for (const char* name : {"R", "G", "B", "Y", "C", "M", "K"}) {
        const int color = image.channel(name);
        if (color < 0) continue;
        for (std::size_t i = 0; i < image.data.size(); i += static_cast<std::size_t>(image.channels)) {
            const float a = image.data[i + static_cast<std::size_t>(alpha)];
            if (a != 0) image.data[i + static_cast<std::size_t>(color)] /= a;
        }
    }
}

// Whether the caller needs the channel: it was named, or it is colour or alpha and none was.
bool is_required(const std::string& name, const std::vector<std::string>& color,
                 const ReadImageOptions& options) {
    if (name == "A") return true;
    const bool listed = options.channels && !options.channels->empty();
    return std::ranges::count(listed ? *options.channels : color, name) > 0;
}

// Leaves out what the options do not ask for, which decode_exr() does not even read. An image without all of
// it stays whole: who asks for its channels then can say what it has.
void select_channels(Image& image, const ReadImageOptions& options) {
    const std::vector<std::string> color = split_names(image.channel_names).color;
    if (!options.channels) return;
    const std::vector<std::string>& wanted = options.channels->empty() ? color : *options.channels;
    if (wanted.empty() ||
        std::ranges::any_of(wanted, [&](const std::string& name) { return image.channel(name) < 0; }))
        return;
    std::vector<char> keep;
    for (const std::string& name : image.channel_names) keep.push_back(is_required(name, color, options));
    keep_channels(image, keep);
}

// Throws Error(kBadFile) for the first pixel of the required channels that is not finite.
void check_finite(const std::string& path, const Image& image, const std::vector<char>& required) {
    std::size_t pixel = image.pixel_count(), channel = 0;
    for (std::size_t c = 0; c < required.size(); ++c) {
        const std::size_t at = required[c] ? first_non_finite(image, static_cast<int>(c)) : pixel;
        if (at >= pixel) continue;
        pixel = at;
        channel = c;
    }
    if (pixel == image.pixel_count()) return;
    throw Error(ErrorKind::kBadFile,
                cat(path, ": channel ", printable(image.channel_names[channel]), " of pixel (",
                    image.x_of(pixel), ", ", image.y_of(pixel), ") is not a finite number"));
}

// Makes samples of a channel finite. Returns false for a channel to leave out.
bool make_finite(const std::string& path, int channel, NonFinite how, ReadImage& out) {
    Image& image = out.image;
    if (first_non_finite(image, channel) == image.pixel_count()) return true;
    const std::string name = printable(image.channel_names[static_cast<std::size_t>(channel)]);
    if (how == NonFinite::kRefuse) {
        out.warnings.push_back(cat("channel ", name, " is left out: it holds numbers that are not finite"));
        return false;
    }
    const std::int64_t count =
        how == NonFinite::kZero ? zero_non_finite(image, channel) : fill_non_finite(image, channel);
    if (count < 0) throw Error(ErrorKind::kBadFile, cat(path, ": channel ", name, " has no finite number"));
    out.non_finite += count;
    return true;
}

// Alpha is first, as colours are divided by it.
void finish_samples(const std::string& path, bool associated_alpha, bool all_required,
                    const ReadImageOptions& options, ReadImage& out) {
    const std::vector<std::string> color = split_names(out.image.channel_names).color;
    std::vector<char> required;
    for (const std::string& name : out.image.channel_names)
        required.push_back(all_required || is_required(name, color, options));
    const bool refuse = options.non_finite == NonFinite::kRefuse;
    const int alpha = out.image.channel("A");
    if (alpha >= 0 && !refuse) make_finite(path, alpha, options.non_finite, out);
    if (associated_alpha) divide_alpha_out(out.image);
    if (refuse) check_finite(path, out.image, required);
    std::vector<char> keep;
    for (int c = 0; c < out.image.channels; ++c)
        keep.push_back(make_finite(path, c, options.non_finite, out));
    if (std::ranges::count(keep, char{1}) == 0)
        throw Error(ErrorKind::kBadFile, cat(path, ": no channel is finite"));
    keep_channels(out.image, keep);
    if (out.non_finite > 0)
        out.warnings.push_back(cat("samples that were not finite and became ",
                                   options.non_finite == NonFinite::kZero ? "0" : "those of pixels nearby",
                                   ": ", out.non_finite));
}

// The code that stands for 1 in the image.
float largest_code(const DecodedPicture& picture, SampleType type) {
    if (picture.largest_code > 0) return picture.largest_code;
    return type == SampleType::kUint8 ? 255.0f : type == SampleType::kUint16 ? 65535.0f : 1.0f;
}

// Turns decoded samples into data: own numbers, and names that are no colours.
void make_values(Image& image, float largest) {
    const auto channels = static_cast<std::size_t>(image.channels);
    const auto alpha = static_cast<std::size_t>(image.channel("A"));  // none is no index
    if (largest != 1)
        for (std::size_t i = 0; i < image.data.size(); ++i)
            if (i % channels != alpha) image.data[i] = std::round(image.data[i] * largest);
    for (std::string& name : image.channel_names) name = value_name(name);
    if (image.sample_type != SampleType::kHalf) image.sample_type = SampleType::kFloat;
    image.color_space = ColorSpace::kLinear;
}

std::vector<std::uint8_t> read_bytes(const std::string& path, const ImageLimits& limits) {
    // A device or a pipe has no size to check beforehand. No more is read than the pixels could need.
    constexpr std::uint64_t kOther = std::uint64_t{64} << 20;  // profiles, previews, metadata
    const std::uint64_t most = kOther + static_cast<std::uint64_t>(limits.max_pixels) *
                                            static_cast<std::uint64_t>(limits.max_channels) * sizeof(float);
    return read_file(path, std::min(kMaxFileBytes, most));
}

// The limits for a file of so many bytes; of those, max_pixels_per_byte is 0 where it does not matter.
ImageLimits limits_for(ImageLimits limits, std::size_t bytes) {
    constexpr std::int64_t kAlways = std::int64_t{1} << 22, kMostBytes = std::int64_t{1} << 30;
    const std::int64_t per_byte = std::clamp<std::int64_t>(limits.max_pixels_per_byte, 0, 1 << 20);
    const std::int64_t most =
        std::max(kAlways, per_byte * std::min(static_cast<std::int64_t>(bytes), kMostBytes));
    if (per_byte == 0 || most >= limits.max_pixels)
        limits.max_pixels_per_byte = 0;
    else
        limits.max_pixels = most;
    return limits;
}

}  // namespace

DecodedPicture decode_picture(const std::string& path, std::span<std::uint8_t> bytes,
                              const ReadImageOptions& options) {
    ReadImageOptions within = options;
    within.limits = limits_for(options.limits, bytes.size());
    const PictureFile file{path, bytes, probe_picture(path, bytes), within};
    switch (file.claim.format) {
        case PictureFormat::kExr:
            return decode_exr(file);
        case PictureFormat::kWebp:
            return decode_webp(file);
        case PictureFormat::kJpeg:
            return decode_jpeg(file);
        case PictureFormat::kPng:
            return decode_png(file);
        case PictureFormat::kTiff:
            return decode_tiff(file);
        case PictureFormat::kBmp:
            return decode_bmp(file);
        case PictureFormat::kPnm:
            return decode_pnm(file);
        case PictureFormat::kTga:
            return decode_tga(file);
        default:
            return decode_with_codecs(file);
    }
}

ReadImage read_image_file(const std::string& path, const ReadImageOptions& options) {
    std::vector<std::uint8_t> bytes = read_bytes(path, options.limits);
    DecodedPicture picture = decode_picture(path, bytes, options);
    if (!picture.has_layers && (options.part || options.layer))
        picture.warnings.emplace_back("it has neither parts nor layers, which only EXR images have");
    ReadImage out{std::move(picture.image),    std::move(picture.warnings),
                  std::move(picture.place),    0,
                  std::move(picture.metadata), {}};
    const float largest = largest_code(picture, out.image.sample_type);
    const bool inks = picture.color.inks;  // yellow is no luminance
    if (!inks) select_channels(out.image, options);
    out.data = std::move(picture.data);
    if (options.nodata && !picture.knows_nodata)
        out.data = take_nodata_out(out.image, *options.nodata, largest);
    finish_samples(path, picture.associated_alpha && !options.values, inks, options, out);
    if (picture.primaries && !options.color_space && !options.values)
        convert_primaries(path, *picture.primaries, kRec709Primaries, out.image);
    if (inks || !options.values) settle_color(picture.color, options.color_space, out.image, out.warnings);
    if (inks) select_channels(out.image, options);
    if (options.values) make_values(out.image, largest);
    out.image = displayed(std::move(out.image), picture.orientation);
    out.data = displayed(std::move(out.data), picture.orientation);
    return out;
}

Image read_image(const std::string& path, const ReadImageOptions& options) {
    return read_image_file(path, options).image;
}

}  // namespace imgmesh
