// write_image: the colour space and samples that the format can hold, its bytes in memory, then one atomic
// write.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <string_view>

#include "formats/atomic_file.h"
#include "formats/icc_profile.h"
#include "formats/image_io.h"
#include "formats/picture_decoders.h"
#include "libcore/base/error.h"
#include "libcore/image/color.h"

namespace imgmesh {
namespace {

using enum SampleType;

struct Format {
    std::string_view extension;
    const char* writer;  ///< OpenImageIO's name; empty for EXR and WebP
    std::vector<SampleType> types;
    bool alpha;
    bool icc;           ///< holds ICC profiles, and so integers of any colour space; without, they are sRGB
    bool any_channels;  ///< else grey or colour, with or without alpha
    int max_side = std::numeric_limits<int>::max();
};

const std::vector<Format>& formats() {
    static const std::vector<Format> kFormats = {
        {".png", "png", {kUint8, kUint16}, true, true, false},
        {".jpg", "jpeg", {kUint8}, false, true, false, 65500},
        {".jpeg", "jpeg", {kUint8}, false, true, false, 65500},
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
    std::string extension = std::filesystem::path(path).extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    const auto& all = formats();
    const auto at =
        std::find_if(all.begin(), all.end(), [&](const Format& f) { return f.extension == extension; });
    return at == all.end() ? nullptr : &*at;
}

bool holds(const Format& format, SampleType type) {
    return std::find(format.types.begin(), format.types.end(), type) != format.types.end();
}

Error unknown_format(const std::string& path) {
    std::string list;
    for (const Format& f : formats()) list += cat(list.empty() ? "" : ", ", f.extension);
    return {ErrorCode::kUsage, cat(path, ": cannot write this kind of picture, expected one of ", list)};
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

// What is asked for; else the image's own type, or the format's next finer one, or its finest.
SampleType choose_type(const std::string& path, const Format& format, const Image& image,
                       std::optional<SampleType> asked) {
    if (asked && !holds(format, *asked))
        throw Error(ErrorCode::kUsage,
                    cat(path, ": ", format.extension, " pictures hold no ", type_name(*asked), " samples"));
    const SampleType wanted = asked.value_or(image.sample_type);
    if (holds(format, wanted)) return wanted;
    // 16-bit codes need a float's precision.
    if (format.extension == ".exr") return wanted == kUint8 ? kHalf : kFloat;
    return format.types.back();
}

ColorSpace choose_space(const Format& format, SampleType type, const Image& image) {
    if (!is_integer(type)) return ColorSpace::kLinear;  // what readers take floats for
    // Linear light from a float picture would lose its shadows in integers.
    const bool light = image.color_space == ColorSpace::kLinear && !is_integer(image.sample_type);
    // An RGB profile does not fit a grey picture.
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

// Without its alpha, which the format cannot hold and which must hide nothing.
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
            throw Error(ErrorCode::kUsage, cat(path, ": ", format.extension,
                                               " pictures hold no transparency, and this one has some; write "
                                               ".png, .webp, .tif or .exr"));
    }
    out.channel_names.clear();
    for (const std::string& name : image.channel_names)
        if (name != "A") out.channel_names.push_back(name);
    return out;
}

void check_shape(const std::string& path, const Format& format, const Image& image) {
    if (image.width > format.max_side || image.height > format.max_side)
        throw Error(ErrorCode::kUsage,
                    cat(path, ": the picture is ", image.width, "x", image.height, ", ", format.extension,
                        " pictures have at most ", format.max_side, " pixels a side"));
    if (format.any_channels) return;
    const auto& names = image.channel_names;
    using Names = std::vector<std::string>;
    if (names == Names{"Y"} || names == Names{"Y", "A"} || names == Names{"R", "G", "B"} ||
        names == Names{"R", "G", "B", "A"})
        return;
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : " ") + name;
    throw Error(ErrorCode::kUsage,
                cat(path, ": ", format.extension, " pictures hold grey or colour, not channels ", list,
                    "; write .exr or .tif"));
}

template <typename T>
std::vector<T> integers(const Image& image) {
    constexpr float kMax = std::numeric_limits<T>::max();
    std::vector<T> out;
    out.reserve(image.data.size());
    for (const float value : image.data)
        out.push_back(static_cast<T>(std::lround(kMax * std::clamp(value, 0.0f, 1.0f))));
    return out;
}

std::vector<std::uint8_t> encode_with_oiio(const std::string& path, const Format& format, const Image& image,
                                           SampleType type) {
    const auto failed = [&](const std::string& reason) {
        // All happens in memory: what the library refuses is what the format cannot hold.
        return Error(ErrorCode::kUsage, cat(path, ": cannot be written: ", one_line(reason)));
    };
    const OIIO::TypeDesc stored = type == kUint8    ? OIIO::TypeUInt8
                                  : type == kUint16 ? OIIO::TypeUInt16
                                  : type == kHalf   ? OIIO::TypeHalf
                                                    : OIIO::TypeFloat;
    OIIO::ImageSpec spec(image.width, image.height, image.channels, stored);
    spec.channelnames = image.channel_names;
    spec.alpha_channel = image.channel("A");
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("DateTime", "");  // TIFF's writer would note the time: not the same bytes twice
    if (std::string_view(format.writer) == "jpeg") {
        spec.attribute("Compression", "jpeg:95");
        spec.attribute("jpeg:subsampling", "4:4:4");
    }
    // Not in TIFF, where it needs an EXIF directory, for which OpenImageIO cannot read its own memory back.
    if (image.color_space == ColorSpace::kSrgb && std::string_view(format.writer) != "tiff")
        spec.attribute("oiio:ColorSpace", "sRGB");
    if (is_integer(type) && image.color_space != ColorSpace::kSrgb) {
        const auto profile = icc_from_color_space(image.color_space);
        spec.attribute("ICCProfile", OIIO::TypeDesc(OIIO::TypeDesc::UINT8, static_cast<int>(profile.size())),
                       profile.data());
    }

    std::vector<std::uint8_t> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(format.writer);
    if (!output)
        throw Error(ErrorCode::kUnsupported, cat(path, ": OpenImageIO is built without ", format.writer));
    output->set_ioproxy(&memory);
    if (!output->open(cat("memory", format.extension), spec)) throw failed(output->geterror());
    const bool written = type == kUint8 ? output->write_image(stored, integers<std::uint8_t>(image).data())
                         : type == kUint16
                             ? output->write_image(stored, integers<std::uint16_t>(image).data())
                             : output->write_image(OIIO::TypeFloat, image.data.data());
    if (!written || !output->close()) throw failed(output->geterror());
    return bytes;
}

}  // namespace

bool can_write_image(const std::string& path) {
    return find_format(path) != nullptr;
}

std::vector<std::uint8_t> encode_image(const std::string& path, const Image& image,
                                       std::optional<SampleType> sample_type) {
    const Format* format = find_format(path);
    if (!format) throw unknown_format(path);
    const SampleType type = choose_type(path, *format, image, sample_type);
    check_shape(path, *format, image);
    Image stored = without_alpha(path, *format, image);
    convert(stored, choose_space(*format, type, image));
    if (format->extension == ".webp") return encode_webp(stored);
    if (format->extension != ".exr") return encode_with_oiio(path, *format, stored, type);
    multiply_alpha_in(stored);
    return encode_exr(stored, type);
}

void write_image(const std::string& path, const Image& image, const WriteImageOptions& options) {
    const Format* format = find_format(path);
    if (!format) throw unknown_format(path);
    choose_type(path, *format, image, options.sample_type);
    check_shape(path, *format, image);
    AtomicFile file(path, options.overwrite);  // before the work: where it cannot be written, all is in vain
    file.write(encode_image(path, image, options.sample_type));
    file.commit();
}

}  // namespace imgmesh
