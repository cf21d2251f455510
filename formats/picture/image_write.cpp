// write_image(): converts to the colour space and samples that the format can hold, encodes in memory, then
// writes atomically.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <string_view>

#include "formats/files/atomic_file.h"
#include "formats/files/extension.h"
#include "formats/picture/codecs/codec_client.h"
#include "formats/picture/color/icc_profile.h"
#include "formats/picture/encode/picture_encoders.h"
#include "formats/picture/image_io.h"
#include "formats/picture/sample_codes.h"
#include "libcore/base/error.h"
#include "libcore/image/color.h"
#include "libcore/image/feature_space.h"

namespace imgmesh {
namespace {

using enum SampleType;

struct Format {
    std::string_view extension;
    const char* writer;  ///< OpenImageIO's name; empty for EXR, JPEG, PNG and WebP
    std::vector<SampleType> types;
    bool alpha;
    bool icc;           ///< holds ICC profiles, and so integers of any colour space; without, they are sRGB
    bool any_channels;  ///< else grey or colour, with or without alpha
    int max_side = std::numeric_limits<int>::max();
};

const std::vector<Format>& formats() {
    static const std::vector<Format> kFormats = {
        {".png", "", {kUint8, kUint16}, true, true, false},
        {".jpg", "", {kUint8}, false, true, false, 65500},
        {".jpeg", "", {kUint8}, false, true, false, 65500},
        {".tif", "tiff", {kUint8, kUint16, kFloat}, true, true, true},
        {".tiff", "tiff", {kUint8, kUint16, kFloat}, true, true, true},
        {".webp", "", {kUint8}, true, false, false, 16383},
        {".exr", "", {kHalf, kFloat}, true, false, true},
        {".bmp", "bmp", {kUint8}, false, false, false},
        {".ppm", "pnm", {kUint8}, false, false, false},
        {".pnm", "pnm", {kUint8}, false, false, false}};
    return kFormats;
}

const Format* find_format(const std::string& path) {
    const std::string extension = lower_extension(path);
    const auto& all = formats();
    const auto at =
        std::find_if(all.begin(), all.end(), [&](const Format& f) { return f.extension == extension; });
    return at == all.end() ? nullptr : &*at;
}

bool holds(const Format& format, SampleType type) {
    return std::find(format.types.begin(), format.types.end(), type) != format.types.end();
}

// Floats without a colour are data.
bool holds_values(const Format& format, SampleType type, const Image& image) {
    return std::string_view(format.writer) == "tiff" && type == kFloat &&
           split_names(image.channel_names).color.empty();
}

Error unknown_format(const std::string& path) {
    std::string list;
    for (const Format& f : formats()) list += cat(list.empty() ? "" : ", ", f.extension);
    return {ErrorKind::kBadArgument, cat(path, ": cannot write this kind of image, expected one of ", list)};
}

const char* type_name(SampleType type) {
    switch (type) {
        case kUint8:
            return "8-bit";
        case kUint16:
            return "16-bit";
        case kHalf:
            return "half";
        case kFloat:
            break;
    }
    return "float";
}

bool is_integer(SampleType type) {
    return type == kUint8 || type == kUint16;
}

// Returns the requested type; else the image's own, or the format's next finer one, or its finest.
SampleType choose_type(const std::string& path, const Format& format, const Image& image,
                       std::optional<SampleType> asked) {
    if (asked && !holds(format, *asked))
        throw Error(ErrorKind::kBadArgument,
                    cat(path, ": ", format.extension, " images hold no ", type_name(*asked), " samples"));
    const SampleType wanted = asked.value_or(image.sample_type);
    if (holds(format, wanted)) return wanted;
    // 16-bit codes need a float's precision.
    if (format.extension == ".exr") return wanted == kUint8 ? kHalf : kFloat;
    return format.types.back();
}

ColorSpace choose_space(const Format& format, SampleType type, const Image& image) {
    if (!is_integer(type)) return ColorSpace::kLinear;  // readers assume that floats are linear
    // Linear values from a float image would lose their shadows in integers.
    const bool light = image.color_space == ColorSpace::kLinear && !is_integer(image.sample_type);
    // An RGB profile does not fit a grey image.
    const bool profile = format.icc && image.channel("R") >= 0;
    return light || !profile ? ColorSpace::kSrgb : image.color_space;
}

void convert(Image& image, ColorSpace space) {
    if (image.color_space == space) return;
    const int red = image.channel("R"), green = image.channel("G"), blue = image.channel("B"),
              grey = image.channel("Y");
    const bool color = red >= 0 && green >= 0 && blue >= 0;
    const auto step = static_cast<std::size_t>(image.channels);
    for (float* p = image.data.data(); p != image.data.data() + image.data.size(); p += step) {
        if (!color && grey < 0) break;
        const Vec3f in = color ? Vec3f(p[red], p[green], p[blue]) : Vec3f::Constant(p[grey]);
        const Vec3f out = encoded_from_linear(space, linear_from_encoded(image.color_space, in));
        if (color) {
            p[red] = out[0];
            p[green] = out[1];
            p[blue] = out[2];
        } else {
            p[grey] = out[1];
        }
    }
    image.color_space = space;
}

void multiply_alpha_in(Image& image) {
    const int alpha = image.channel("A");
    if (alpha < 0) return;
    const auto step = static_cast<std::size_t>(image.channels);
    for (const char* name : {"R", "G", "B", "Y"}) {
        const int color = image.channel(name);
        if (color < 0) continue;
        for (float* p = image.data.data(); p != image.data.data() + image.data.size(); p += step)
            p[color] *= p[alpha];
    }
}

// Returns the image without its alpha, which the format cannot hold and which must hide nothing.
Image without_alpha(const std::string& path, const Format& format, Image image) {
    const int alpha = image.channel("A");
    if (format.alpha || alpha < 0) return image;
    constexpr float kOpaque = 1 - 0.5f / 255;  // stored as 255 of 255
    Image out = make_image(image.width, image.height, image.channels - 1);
    out.sample_type = image.sample_type;
    out.color_space = image.color_space;
    float* to = out.data.data();
    for (std::size_t i = 0; i < image.data.size(); ++i) {
        if (i % static_cast<std::size_t>(image.channels) != static_cast<std::size_t>(alpha))
            *to++ = image.data[i];
        else if (!(image.data[i] >= kOpaque))
            throw Error(ErrorKind::kBadArgument,
                        cat(path, ": ", format.extension,
                            " images hold no transparency, and this one has some; write "
                            ".png, .webp, .tif or .exr"));
    }
    out.channel_names.clear();
    for (const std::string& name : image.channel_names)
        if (name != "A") out.channel_names.push_back(name);
    return out;
}

void check_shape(const std::string& path, const Format& format, const Image& image) {
    if (image.width > format.max_side || image.height > format.max_side)
        throw Error(ErrorKind::kBadArgument,
                    cat(path, ": the image is ", image.width, "x", image.height, ", ", format.extension,
                        " images have at most ", format.max_side, " pixels a side"));
    if (format.any_channels) return;
    const auto& names = image.channel_names;
    using Names = std::vector<std::string>;
    if (names == Names{"Y"} || names == Names{"Y", "A"} || names == Names{"R", "G", "B"} ||
        names == Names{"R", "G", "B", "A"})
        return;
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : " ") + name;
    throw Error(ErrorKind::kBadArgument,
                cat(path, ": ", format.extension, " images hold grey or colour, not channels ", list,
                    "; write .exr or .tif"));
}

template <typename T>
std::span<const std::uint8_t> bytes_of(const std::vector<T>& values) {
    return {reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(T)};
}

std::vector<std::uint8_t> encode_with_oiio(const std::string& path, const Format& format, const Image& image,
                                           SampleType type) {
    EncodeTask task{path,
                    format.writer,
                    std::string(format.extension),
                    image.width,
                    image.height,
                    image.channel_names,
                    image.channel("A"),
                    type,
                    image.color_space == ColorSpace::kSrgb,
                    {}};
    if (is_integer(type) && image.color_space != ColorSpace::kSrgb)
        task.icc = icc_from_color_space(image.color_space);
    if (type == kUint8) return encode_with_codecs(task, codes8_from_floats(image.data));
    if (type == kUint16) return encode_with_codecs(task, bytes_of(codes16_from_floats(image.data)));
    return encode_with_codecs(task, bytes_of(image.data));
}

}  // namespace

bool can_write_image(const std::string& path) {
    return find_format(path) != nullptr;
}

StoredImage stored_image(const std::string& path, const Image& image, std::optional<SampleType> sample_type) {
    const Format* format = find_format(path);
    if (!format) throw unknown_format(path);
    const SampleType type = choose_type(path, *format, image, sample_type);
    check_shape(path, *format, image);
    StoredImage stored{without_alpha(path, *format, image), type};
    convert(stored.image, choose_space(*format, type, image));
    return stored;
}

std::vector<std::uint8_t> encode_image(const std::string& path, const Image& image,
                                       std::optional<SampleType> sample_type, const ExrMetadata& metadata) {
    const Format* format = find_format(path);
    if (!format) throw unknown_format(path);
    if (holds_values(*format, choose_type(path, *format, image, sample_type), image))
        return encode_tiff_values(image);
    auto [stored, type] = stored_image(path, image, sample_type);
    if (format->extension == ".webp") return encode_webp(stored);
    if (format->extension == ".png") return encode_png(stored, type);
    if (format->extension == ".jpg" || format->extension == ".jpeg") return encode_jpeg(stored);
    if (format->extension != ".exr") return encode_with_oiio(path, *format, stored, type);
    multiply_alpha_in(stored);
    return encode_exr(std::move(stored), type, metadata);
}

void write_image(const std::string& path, const Image& image, const WriteImageOptions& options) {
    const Format* format = find_format(path);
    if (!format) throw unknown_format(path);
    choose_type(path, *format, image, options.sample_type);
    check_shape(path, *format, image);
    AtomicFile file(path, options.overwrite);  // first: if it fails, the work would be useless
    file.write(encode_image(path, image, options.sample_type, options.metadata));
    file.commit();
}

}  // namespace imgmesh
