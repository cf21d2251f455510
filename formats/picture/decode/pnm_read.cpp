// Netpbm's formats: PBM, PGM and PPM as text and as bytes, PAM, and PFM of floats.
// Sources: the manual pages pbm(5), pgm(5), ppm(5), pam(5) and pfm(5) of Netpbm.
#include <algorithm>
#include <bit>
#include <cmath>
#include <string_view>

#include "formats/files/byte_reader.h"
#include "formats/picture/decode/pam_header.h"
#include "formats/picture/decode/picture_decoders.h"
#include "formats/picture/decode/pnm_text.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

using Bytes = std::span<const std::uint8_t>;

struct Pnm {
    const PictureFile& file;
    PnmText text;

    Error broken(const std::string& what) const { return {ErrorKind::kBadFile, cat(file.path, ": ", what)}; }

    // Makes the image once its size is within the limits and its samples can be in the file, `bits` each.
    Image image(std::int64_t width, std::int64_t height, int channels, std::int64_t row_bits) const {
        check_size(file.path, width, height, channels, file.options.limits);
        const std::int64_t needed = (row_bits + 7) / 8 * height;
        const auto left = static_cast<std::int64_t>(text.rest().size());
        if (needed > left)
            throw broken(cat("the image is truncated: its pixels take at least ", needed, " bytes, ", left,
                             " are left"));
        return make_image(static_cast<int>(width), static_cast<int>(height), channels);
    }
};

// Samples above the largest are read as the largest.
struct Scale {
    std::int64_t largest;
    std::int64_t above = 0;

    float operator()(std::int64_t value) {
        if (value > largest) ++above;
        return static_cast<float>(std::min(value, largest)) / static_cast<float>(largest);
    }
    void tell(DecodedPicture& out) const {
        if (above > 0)
            out.warnings.push_back(
                cat("samples above the file's largest value, ", largest, ", which were read as it: ", above));
    }
};

SampleType type_of(std::int64_t largest) {
    return largest > 255 ? SampleType::kUint16 : SampleType::kUint8;
}

void read_codes(Bytes bytes, Scale& scale, Image& image) {
    if (scale.largest < 256) {
        for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = scale(bytes[i]);
        return;
    }
    for (std::size_t i = 0; i < image.data.size(); ++i)
        image.data[i] = scale(bytes[2 * i] << 8 | bytes[2 * i + 1]);
}

// P1 to P6.
DecodedPicture read_pnm(Pnm& in, int kind) {
    const bool bits = kind == 1 || kind == 4, plain = kind < 4;
    const int channels = kind == 3 || kind == 6 ? 3 : 1;
    const std::int64_t width = in.text.number("width"), height = in.text.number("height");
    Scale scale{bits ? 1 : in.text.number("largest value")};
    if (scale.largest < 1 || scale.largest > 65535)
        throw in.broken(cat("the largest value is ", scale.largest, ", expected 1 to 65535"));
    in.text.end_header();
    // A number of a text takes a digit, and a space before the next one. Digits of P1 may follow each other.
    const std::int64_t sample_bits = bits ? (plain ? 8 : 1) : plain || scale.largest > 255 ? 16 : 8;
    const std::int64_t unneeded = plain && !bits && width > 0 ? 8 : 0;  // no space after the last
    DecodedPicture out;
    out.image = in.image(width, height, channels, width * channels * sample_bits - unneeded);
    out.image.sample_type = type_of(scale.largest);
    if (kind == 1) {
        for (float& sample : out.image.data) sample = in.text.bit() ? 0 : 1;
    } else if (plain) {
        for (float& sample : out.image.data) sample = scale(in.text.number("sample"));
    } else if (kind == 4) {
        const Bytes bytes = in.text.rest();
        const auto row = static_cast<std::size_t>((width + 7) / 8);
        for (int y = 0; y < out.image.height; ++y)
            for (int x = 0; x < out.image.width; ++x) {
                const auto column = static_cast<std::size_t>(x);
                const int byte = bytes[static_cast<std::size_t>(y) * row + column / 8];
                *out.image.pixel(x, y) = byte >> (7 - column % 8) & 1 ? 0 : 1;
            }
    } else {
        read_codes(in.text.rest(), scale, out.image);
    }
    scale.tell(out);
    out.largest_code = static_cast<float>(scale.largest);
    return out;
}

// Rows from the bottom up. A negative scale says little-endian; its size is the unit of the samples.
DecodedPicture read_pfm(Pnm& in, int channels) {
    const std::int64_t width = in.text.number("width"), height = in.text.number("height");
    const float scale = in.text.real("scale");
    if (scale == 0) throw in.broken("the scale is 0, expected another number");
    in.text.end_header();
    DecodedPicture out;
    out.image = in.image(width, height, channels, width * channels * 32);
    out.image.sample_type = SampleType::kFloat;
    ByteReader bytes(in.text.rest(), scale < 0 ? ByteOrder::kLittle : ByteOrder::kBig);
    for (int y = out.image.height - 1; y >= 0; --y)
        for (int i = 0; i < out.image.width * channels; ++i)
            out.image.pixel(0, y)[i] = std::bit_cast<float>(bytes.number(4)) * std::abs(scale);
    return out;
}

// Names by the type where it is one of the manual's, else by the depth, as make_image() gives them.
void name_channels(const Pnm& in, const PamHeader& header, Image& image) {
    struct Type {
        std::string_view name;
        std::vector<std::string> channels;
    };
    const Type types[] = {{"BLACKANDWHITE", {"Y"}},        {"GRAYSCALE", {"Y"}},
                          {"RGB", {"R", "G", "B"}},        {"BLACKANDWHITE_ALPHA", {"Y", "A"}},
                          {"GRAYSCALE_ALPHA", {"Y", "A"}}, {"RGB_ALPHA", {"R", "G", "B", "A"}}};
    const auto type = std::ranges::find(types, std::string_view(header.type), &Type::name);
    if (type == std::end(types)) return;
    if (type->channels.size() > static_cast<std::size_t>(image.channels))
        throw in.broken(cat("the PAM's type is ", type->name, " and its depth ", image.channels,
                            ", expected ", type->channels.size()));
    for (int c = 0; c < image.channels; ++c) {
        const auto channel = static_cast<std::size_t>(c);
        image.channel_names[channel] =
            channel < type->channels.size() ? type->channels[channel] : cat("C", c);
    }
}

DecodedPicture read_pam(Pnm& in) {
    const PamHeader header = pam_header(in.file.path, in.text);
    Scale scale{header.largest};
    if (scale.largest < 1 || scale.largest > 65535)
        throw in.broken(cat("the largest value is ", scale.largest, ", expected 1 to 65535"));
    const ImageLimits& limits = in.file.options.limits;
    check_size(in.file.path, header.width, header.height, header.depth, limits);
    DecodedPicture out;
    out.image = in.image(header.width, header.height, static_cast<int>(header.depth),
                         header.width * header.depth * (scale.largest > 255 ? 16 : 8));
    out.image.sample_type = type_of(scale.largest);
    name_channels(in, header, out.image);
    out.color.inks = header.type.starts_with("CMYK");
    const int inks = header.type == "CMYK_ALPHA" ? 5 : 4;
    if (out.color.inks && out.image.channels < inks)
        throw in.broken(cat("the PAM's type is ", printable(header.type), " and its depth ",
                            out.image.channels, ", expected ", inks));
    read_codes(in.text.rest(), scale, out.image);
    scale.tell(out);
    out.largest_code = static_cast<float>(scale.largest);
    return out;
}

}  // namespace

DecodedPicture decode_pnm(const PictureFile& file) {
    Pnm in{file, PnmText(file.path, Bytes(file.bytes).subspan(2))};
    const char kind = static_cast<char>(file.bytes[1]);
    if (kind == 'F') return read_pfm(in, 3);
    if (kind == 'f') return read_pfm(in, 1);
    if (kind == '7') return read_pam(in);
    return read_pnm(in, kind - '0');
}

}  // namespace imgmesh
