#include "formats/picture/decode/finish_picture.h"

#include <algorithm>
#include <cmath>

#include "formats/picture/color/primaries.h"
#include "formats/picture/decode/keep_channels.h"
#include "formats/picture/decode/nodata.h"
#include "formats/picture/decode/non_finite.h"
#include "formats/picture/decode/orientation.h"
#include "libcore/base/error.h"
#include "libcore/image/feature_space.h"

namespace imgmesh {
namespace {

void copy_pixel(const Image& from, std::size_t i, Image& to, std::size_t j) {
    std::copy_n(from.pixel(i), from.channels, to.pixel(j));
}
void copy_pixel(const Mask& from, std::size_t i, Mask& to, std::size_t j) {
    to.values[j] = from.values[i];
}

template <typename Pixels>
Pixels displayed(Pixels stored, int orientation) {
    const Orientation o = orientation_of(orientation);
    if (o == Orientation()) return stored;
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

}  // namespace

ReadImage finish_picture(const std::string& path, DecodedPicture picture, const ReadImageOptions& options) {
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
    picture.color.fitting = options.fitting_space;
    if (inks || !options.values) settle_color(picture.color, options.color_space, out.image, out.warnings);
    if (inks) select_channels(out.image, options);
    if (options.values) make_values(out.image, largest);
    out.image = displayed(std::move(out.image), picture.orientation);
    out.data = displayed(std::move(out.data), picture.orientation);
    return out;
}

}  // namespace imgmesh
