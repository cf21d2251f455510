// All formats but EXR and WebP, through OpenImageIO.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string_view>

#include "formats/icc_profile.h"
#include "formats/picture_decoders.h"
#include "libcore/base/error.h"
#include "libcore/image/color.h"

namespace imgmesh {
namespace {

const char* reader_name(PictureFormat format) {
    switch (format) {
        case PictureFormat::kPng:
            return "png";
        case PictureFormat::kJpeg:
            return "jpeg";
        case PictureFormat::kTiff:
            return "tiff";
        case PictureFormat::kGif:
            return "gif";
        case PictureFormat::kBmp:
            return "bmp";
        case PictureFormat::kPnm:
            return "pnm";
        case PictureFormat::kTga:
            return "targa";
        case PictureFormat::kHdr:
            return "hdr";
        case PictureFormat::kJpeg2000:
            return "jpeg2000";
        case PictureFormat::kHeif:
            return "heif";
        case PictureFormat::kExr:
        case PictureFormat::kWebp:
            break;
    }
    return "";
}

SampleType sample_type(const std::string& path, OIIO::TypeDesc type) {
    switch (type.basetype) {
        case OIIO::TypeDesc::UINT8:
            return SampleType::kUint8;
        case OIIO::TypeDesc::UINT16:
        case OIIO::TypeDesc::UINT32:
            return SampleType::kUint16;
        case OIIO::TypeDesc::HALF:
            return SampleType::kHalf;
        case OIIO::TypeDesc::FLOAT:
        case OIIO::TypeDesc::DOUBLE:
            return SampleType::kFloat;
        default:
            throw Error(ErrorCode::kUnsupported, cat(path, ": samples of type ", type.c_str(),
                                                     ", expected unsigned integers or floats"));
    }
}

void check_spec(const std::string& path, const OIIO::ImageSpec& spec, const ImageLimits& limits) {
    if (spec.deep || spec.depth > 1)
        throw Error(ErrorCode::kUnsupported, cat(path, ": deep and volume pictures are not supported"));
    check_size(path, spec.width, spec.height, spec.nchannels, limits);
    // One tile is held at a time.
    if (spec.tile_width > 0) check_size(path, spec.tile_width, spec.tile_height, spec.nchannels, limits);
    // CMYK and YCbCr arrive as RGB; CIELAB and its kin arrive as they are.
    const std::string photometric = spec.get_string_attribute("tiff:ColorSpace");
    if (!photometric.empty() && photometric != "CMYK" && photometric != "YCbCr")
        throw Error(ErrorCode::kUnsupported,
                    cat(path, ": TIFF colours as ", photometric, " are not supported"));
}

// Some readers call the fourth channel alpha by name only, and GIF's counts it wrongly.
int alpha_channel(const OIIO::ImageSpec& spec) {
    if (spec.alpha_channel >= 0 && spec.alpha_channel < spec.nchannels) return spec.alpha_channel;
    const auto at = std::find(spec.channelnames.begin(), spec.channelnames.end(), "A");
    return at == spec.channelnames.end() ? -1 : static_cast<int>(at - spec.channelnames.begin());
}

std::vector<std::string> channel_names(const OIIO::ImageSpec& spec) {
    std::vector<std::string> names = spec.channelnames;
    names.resize(static_cast<std::size_t>(spec.nchannels));
    const int alpha = alpha_channel(spec);
    if (alpha >= 0) names[static_cast<std::size_t>(alpha)] = std::string("A");
    if (spec.nchannels < 3 && alpha != 0) names[0] = std::string("Y");
    return names;
}

// The colour space by the names of OpenImageIO, where the file says one. A PNG with a gamma that is none of
// ours is brought to 2.2.
std::optional<ColorSpace> color_space(const OIIO::ImageSpec& spec, PictureFormat format, Image& image) {
    if (const OIIO::ParamValue* icc = spec.find_attribute("ICCProfile")) {
        const auto* data = static_cast<const std::uint8_t*>(icc->data());
        const auto space = color_space_from_icc({data, static_cast<std::size_t>(icc->datasize())});
        if (space) return space;
    }
    // Netpbm's specification names Rec.709, and all software means sRGB; no file says either.
    if (format == PictureFormat::kPnm) return std::nullopt;
    const std::string name = spec.get_string_attribute("oiio:ColorSpace");
    const float gamma = spec.get_float_attribute("oiio:Gamma", 0.0f);
    if (name.starts_with("Gamma") && gamma > 0 && std::isfinite(gamma)) {
        constexpr float kOurs = 2.2f, kTolerance = 0.05f;
        if (std::abs(gamma - kOurs) <= kTolerance) return ColorSpace::kGamma22;
        if (std::abs(gamma - 1) <= kTolerance) return ColorSpace::kLinear;
        const int alpha = image.channel("A");
        for (std::size_t i = 0; i < image.data.size(); ++i)
            if (alpha < 0 || i % static_cast<std::size_t>(image.channels) != static_cast<std::size_t>(alpha))
                image.data[i] = std::pow(image.data[i], gamma / kOurs);
        return ColorSpace::kGamma22;
    }
    return parse_color_space(name);
}

// Integers of type T as floats in [0, 1], exactly code / maximum; OpenImageIO multiplies by an inverse.
template <typename T>
bool read_codes(OIIO::ImageInput& input, OIIO::TypeDesc type, std::vector<float>& out) {
    std::vector<T> codes(out.size());
    if (!input.read_image(0, 0, 0, input.spec().nchannels, type, codes.data())) return false;
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = static_cast<float>(codes[i]) / static_cast<float>(std::numeric_limits<T>::max());
    return true;
}

bool read_samples(OIIO::ImageInput& input, SampleType type, std::vector<float>& out) {
    switch (type) {
        case SampleType::kUint8:
            return read_codes<std::uint8_t>(input, OIIO::TypeUInt8, out);
        case SampleType::kUint16:
            return read_codes<std::uint16_t>(input, OIIO::TypeUInt16, out);
        case SampleType::kHalf:
        case SampleType::kFloat:
            break;
    }
    return input.read_image(0, 0, 0, input.spec().nchannels, OIIO::TypeFloat, out.data());
}

void use_one_thread() {
    // OpenImageIO's own pool would ignore the caller's limit; pictures of a batch run in parallel anyway.
    static const bool kDone = OIIO::attribute("threads", 1);
    (void)kDone;
}

}  // namespace

DecodedPicture decode_with_oiio(const std::string& path, std::span<const std::uint8_t> bytes,
                                const PictureClaim& claim, const ImageLimits& limits) {
    use_one_thread();
    const std::string format = reader_name(claim.format);
    const auto broken = [&](const std::string& reason) {
        return Error(ErrorCode::kBadFile, cat(path, ": cannot read the picture: ", one_line(reason)));
    };
    if (claim.width != 0 || claim.height != 0)
        check_size(path, claim.width, claim.height, std::max<std::int64_t>(claim.channels, 1), limits);
    try {
        OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
        const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(format);
        if (!input)
            throw Error(ErrorCode::kUnsupported, cat(path, ": OpenImageIO is built without ", format));
        OIIO::ImageSpec config, spec;
        config.attribute("oiio:UnassociatedAlpha", 1);
        if (input->supports("ioproxy")) input->set_ioproxy(&memory);
        if (!input->open(path, spec, config)) throw broken(input->geterror());
        check_spec(path, spec, limits);

        DecodedPicture out;
        out.image.sample_type = sample_type(path, spec.format);
        out.image.width = spec.width;
        out.image.height = spec.height;
        out.image.channels = spec.nchannels;
        out.image.channel_names = channel_names(spec);
        out.image.data.resize(out.image.pixel_count() * static_cast<std::size_t>(spec.nchannels));
        // libjpeg and others say of a truncated file no more than a warning: an error that is told counts.
        if (!read_samples(*input, out.image.sample_type, out.image.data) || input->has_error())
            throw broken(input->geterror());
        // Asked for alpha as stored, TIFF's reader says when it stands alone; the others never multiply.
        out.associated_alpha =
            claim.format == PictureFormat::kTiff && spec.get_int_attribute("oiio:UnassociatedAlpha") == 0;
        out.orientation = spec.get_int_attribute("Orientation", 1);
        out.color_space = color_space(spec, claim.format, out.image);
        return out;
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& e) {
        throw broken(e.what());
    }
}

}  // namespace imgmesh
