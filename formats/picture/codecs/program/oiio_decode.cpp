// Images that OpenImageIO reads.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <sys/mman.h>

#include <algorithm>
#include <memory>
#include <new>
#include <optional>

#include "formats/files/library_error.h"
#include "formats/files/one_line.h"
#include "formats/picture/codecs/program/codecs.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

const char* reader_name(PictureFormat format) {
    switch (format) {
        case PictureFormat::kGif:
            return "gif";
        case PictureFormat::kHdr:
            return "hdr";
        case PictureFormat::kJpeg2000:
            return "jpeg2000";
        default:
            throw Error(ErrorKind::kInternal, "a format that imgmesh reads itself");
    }
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

void check_spec(const std::string& path, const OIIO::ImageSpec& spec, const ImageLimits& limits) {
    if (spec.deep || spec.depth > 1)
        throw Error(ErrorKind::kUnsupported, cat(path, ": deep and volume images are not supported"));
    check_size(path, spec.width, spec.height, spec.nchannels, limits);
    // One tile is held at a time.
    if (spec.tile_width > 0)
        check_block_size(path, spec.tile_width, spec.tile_height, spec.nchannels, limits);
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
void state_color(const OIIO::ImageSpec& spec, CodecPicture& out) {
    if (const OIIO::ParamValue* icc = spec.find_attribute("ICCProfile")) {
        const auto* data = static_cast<const std::uint8_t*>(icc->data());
        out.color.icc.assign(data, data + icc->datasize());
    }
    out.color.name = spec.get_string_attribute("oiio:ColorSpace");
    if (out.color.name.starts_with("Gamma")) out.color.gamma = spec.get_float_attribute("oiio:Gamma", 0.0f);
}

OIIO::TypeDesc exchanged_type(SampleType type) {
    switch (type) {
        case SampleType::kUint8:
            return OIIO::TypeUInt8;
        case SampleType::kUint16:
            return OIIO::TypeUInt16;
        case SampleType::kHalf:
        case SampleType::kFloat:
            break;
    }
    return OIIO::TypeFloat;
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

// The bytes as a file without a name, for readers that open files themselves.
class UnnamedFile {
  public:
    explicit UnnamedFile(std::span<const std::uint8_t> bytes) : file_(::memfd_create("image", MFD_CLOEXEC)) {
        while (!bytes.empty()) {
            const ssize_t n = ::write(file_.get(), bytes.data(), bytes.size());
            if (n <= 0) throw std::bad_alloc();
            bytes = bytes.subspan(static_cast<std::size_t>(n));
        }
    }
    std::string path() const { return cat("/proc/self/fd/", file_.get()); }

  private:
    FileDescriptor file_;
};

}  // namespace

void decode_by_oiio(const DecodeTask& task, std::span<const std::uint8_t> bytes, const OfferPicture& offer) {
    const std::string format = reader_name(task.claim.format);
    const std::string cannot_read = cat(task.path, ": cannot read the image");
    const auto broken = [&](const std::string& reason) {
        return Error(ErrorKind::kBadFile, cat(cannot_read, ": ", one_line(reason)));
    };
    translate_errors(ErrorKind::kBadFile, cannot_read, [&] {
        BoundedReader memory(bytes.data(), bytes.size());
        const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(format);
        if (!input)
            throw Error(ErrorKind::kUnsupported, cat(task.path, ": OpenImageIO is built without ", format));
        OIIO::ImageSpec config, spec;
        config.attribute("oiio:UnassociatedAlpha", 1);
        std::optional<UnnamedFile> file;
        if (input->supports("ioproxy"))
            input->set_ioproxy(&memory);
        else
            file.emplace(bytes);
        if (!input->open(file ? file->path() : task.path, spec, config)) throw broken(input->geterror());
        check_spec(task.path, spec, task.limits);

        CodecPicture out;
        out.sample_type = sample_type(task.path, spec.format);
        out.width = spec.width;
        out.height = spec.height;
        out.channels = spec.nchannels;
        out.channel_names = channel_names(spec);
        out.orientation = spec.get_int_attribute("Orientation", 1);
        state_color(spec, out);
        const std::span<std::uint8_t> samples = offer(out);
        // libjpeg and others only warn about a truncated file: a reported error counts.
        if (!input->read_image(0, 0, 0, spec.nchannels, exchanged_type(out.sample_type), samples.data()) ||
            input->has_error())
            throw broken(input->geterror());
    });
}

}  // namespace imgmesh
