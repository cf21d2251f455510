// The module behind oiio_module.h. Nothing of imgmesh is linked to it, so there is one copy of
// everything.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string_view>

#include "formats/files/library_error.h"
#include "formats/files/one_line.h"
#include "formats/picture/oiio_module.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

const char* reader_name(PictureFormat format) {
    switch (format) {
        case PictureFormat::kJpeg:
            return "jpeg";
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
        case PictureFormat::kPng:
        case PictureFormat::kTiff:
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
            throw Error(ErrorKind::kUnsupported, cat(path, ": samples of type ", type.c_str(),
                                                     ", expected unsigned integers or floats"));
    }
}

void check_spec(const std::string& path, const OIIO::ImageSpec& spec, const ImageLimits& limits,
                decltype(&check_size) check) {
    if (spec.deep || spec.depth > 1)
        throw Error(ErrorKind::kUnsupported, cat(path, ": deep and volume images are not supported"));
    check(path, spec.width, spec.height, spec.nchannels, limits);
    // One tile is held at a time.
    if (spec.tile_width > 0) check(path, spec.tile_width, spec.tile_height, spec.nchannels, limits);
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

// What the file says about its colours, under OpenImageIO's names.
void state_color(const OIIO::ImageSpec& spec, PictureFormat format, OiioPicture& out) {
    if (const OIIO::ParamValue* icc = spec.find_attribute("ICCProfile")) {
        const auto* data = static_cast<const std::uint8_t*>(icc->data());
        out.icc.assign(data, data + icc->datasize());
    }
    // Netpbm's specification names Rec.709, but all software writes sRGB; no file says which.
    if (format == PictureFormat::kPnm) return;
    out.color_name = spec.get_string_attribute("oiio:ColorSpace");
    if (out.color_name.starts_with("Gamma")) out.gamma = spec.get_float_attribute("oiio:Gamma", 0.0f);
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
    // OpenImageIO's own pool would ignore the caller's limit; images of a batch run in parallel anyway.
    static const bool kDone = OIIO::attribute("threads", 1);
    (void)kDone;
}

// Bytes in memory, with nothing before or after them. OpenImageIO's own reader (2.4) reads before the first
// byte if a file sends it to a negative place. Here such a place counts as missing, as if it were after the
// end.
class BoundedReader : public OIIO::Filesystem::IOMemReader {
  public:
    using IOMemReader::IOMemReader;
    std::size_t read(void* out, std::size_t count) override {
        return is_inside(tell()) ? IOMemReader::read(out, count) : 0;
    }
    std::size_t pread(void* out, std::size_t count, std::int64_t at) override {
        return is_inside(at) ? IOMemReader::pread(out, count, at) : 0;
    }

  private:
    bool is_inside(std::int64_t at) const { return at >= 0 && static_cast<std::uint64_t>(at) <= size(); }
};

OiioPicture decode(const std::string& path, std::span<const std::uint8_t> bytes, const PictureClaim& claim,
                   const ImageLimits& limits, decltype(&check_size) check) {
    use_one_thread();
    const std::string format = reader_name(claim.format);
    const std::string cannot_read = cat(path, ": cannot read the image");
    const auto broken = [&](const std::string& reason) {
        return Error(ErrorKind::kBadFile, cat(cannot_read, ": ", one_line(reason)));
    };
    if (claim.width != 0 || claim.height != 0)
        check(path, claim.width, claim.height, std::max<std::int64_t>(claim.channels, 1), limits);
    return translate_errors(ErrorKind::kBadFile, cannot_read, [&] {
        BoundedReader memory(bytes.data(), bytes.size());
        const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(format);
        if (!input)
            throw Error(ErrorKind::kUnsupported, cat(path, ": OpenImageIO is built without ", format));
        OIIO::ImageSpec config, spec;
        config.attribute("oiio:UnassociatedAlpha", 1);
        if (input->supports("ioproxy")) input->set_ioproxy(&memory);
        if (!input->open(path, spec, config)) throw broken(input->geterror());
        check_spec(path, spec, limits, check);

        OiioPicture out;
        out.sample_type = sample_type(path, spec.format);
        out.width = spec.width;
        out.height = spec.height;
        out.channels = spec.nchannels;
        out.channel_names = channel_names(spec);
        out.data.resize(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) *
                        static_cast<std::size_t>(spec.nchannels));
        // libjpeg and others only warn about a truncated file: a reported error counts.
        if (!read_samples(*input, out.sample_type, out.data) || input->has_error())
            throw broken(input->geterror());
        out.orientation = spec.get_int_attribute("Orientation", 1);
        state_color(spec, claim.format, out);
        return out;
    });
}

std::vector<std::uint8_t> encode(const std::string& path, const OiioTask& task) {
    const auto failed = [&](const std::string& reason) {
        // All happens in memory, so the library refuses only what the format cannot hold.
        return Error(ErrorKind::kBadArgument, cat(path, ": cannot be written: ", one_line(reason)));
    };
    const OIIO::TypeDesc stored = task.type == SampleType::kUint8    ? OIIO::TypeUInt8
                                  : task.type == SampleType::kUint16 ? OIIO::TypeUInt16
                                                                     : OIIO::TypeFloat;
    OIIO::ImageSpec spec(task.width, task.height, static_cast<int>(task.channel_names.size()), stored);
    spec.channelnames = task.channel_names;
    spec.alpha_channel = task.alpha_channel;
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("DateTime", "");  // TIFF's writer would write the time, so bytes would differ
    if (std::string_view(task.writer) == "jpeg") {
        spec.attribute("Compression", "jpeg:95");
        spec.attribute("jpeg:subsampling", "4:4:4");
    }
    // Not in TIFF, where it needs an EXIF directory, for which OpenImageIO cannot read its own memory back.
    if (task.say_srgb && std::string_view(task.writer) != "tiff") spec.attribute("oiio:ColorSpace", "sRGB");
    if (!task.icc.empty())
        spec.attribute("ICCProfile", OIIO::TypeDesc(OIIO::TypeDesc::UINT8, static_cast<int>(task.icc.size())),
                       task.icc.data());

    std::vector<std::uint8_t> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(task.writer);
    if (!output)
        throw Error(ErrorKind::kUnsupported, cat(path, ": OpenImageIO is built without ", task.writer));
    output->set_ioproxy(&memory);
    if (!output->open(cat("memory", task.extension), spec)) throw failed(output->geterror());
    if (!output->write_image(stored, task.samples) || !output->close()) throw failed(output->geterror());
    return bytes;
}

OIIO::ImageBufAlgo::TextAlignX oiio_align(TextAlign align) {
    switch (align) {
        case TextAlign::kLeft:
            return OIIO::ImageBufAlgo::TextAlignX::Left;
        case TextAlign::kCenter:
            return OIIO::ImageBufAlgo::TextAlignX::Center;
        case TextAlign::kRight:
            break;
    }
    return OIIO::ImageBufAlgo::TextAlignX::Right;
}

void text(Image& image, const TextLabel& label) {
    const OIIO::ImageSpec spec(image.width, image.height, image.channels, OIIO::TypeFloat);
    OIIO::ImageBuf buffer(spec, image.data.data());  // draws into the image itself
    if (!OIIO::ImageBufAlgo::render_text(buffer, label.x, label.y, label.text, label.size, "DejaVuSans",
                                         {label.color.data(), 3}, oiio_align(label.align),
                                         OIIO::ImageBufAlgo::TextAlignY::Baseline))
        throw Error(ErrorKind::kUnsupported, cat("cannot draw text: ", one_line(buffer.geterror())));
}

constexpr OiioModule kModule = {decode, encode, text};

}  // namespace
}  // namespace imgmesh

extern "C" __attribute__((visibility("default"))) const imgmesh::OiioModule* imgmesh_oiio_module() {
    return &imgmesh::kModule;
}
