#include <cmath>
#include <utility>

#include "formats/picture/codecs/program/codecs.h"
#include "formats/picture/codecs/program/hevc_color.h"
#include "formats/picture/color/stated_color.h"
#include "formats/picture/decode/picture_decoders.h"
#include "formats/picture/image_io.h"
#include "tests/fuzz/feeds.h"

namespace imgmesh::fuzz {
namespace {

PictureFormat format_of(Target target) {
    switch (target) {
        case Target::kPng:
            return PictureFormat::kPng;
        case Target::kJpeg:
            return PictureFormat::kJpeg;
        case Target::kTiff:
            return PictureFormat::kTiff;
        case Target::kExr:
            return PictureFormat::kExr;
        case Target::kWebp:
            return PictureFormat::kWebp;
        case Target::kBmp:
            return PictureFormat::kBmp;
        case Target::kTga:
            return PictureFormat::kTga;
        case Target::kPnm:
            return PictureFormat::kPnm;
        case Target::kGif:
            return PictureFormat::kGif;
        case Target::kHdr:
            return PictureFormat::kHdr;
        case Target::kJp2:
            return PictureFormat::kJpeg2000;
        case Target::kHeif:
            return PictureFormat::kHeif;
        default:
            throw std::logic_error("a target that is no image");
    }
}

// A file of a few kilobytes could promise 2^28 pixels, each time for a second or two.
ReadImageOptions usual_options() {
    ReadImageOptions options;
    options.limits.max_pixels = 1 << 18;
    return options;
}

// What read_image_file() promises of any image.
void check_image(const ReadImage& read) {
    const Image& image = read.image;
    if (image.width < 1 || image.height < 1 ||
        image.channel_names.size() != static_cast<std::size_t>(image.channels) ||
        image.data.size() != image.pixel_count() * static_cast<std::size_t>(image.channels))
        throw std::logic_error("an image without the samples of its size");
    for (const float sample : image.data)
        if (!std::isfinite(sample)) throw std::logic_error("a sample that is not finite");
    if (!read.data.empty() && (read.data.width != image.width || read.data.height != image.height))
        throw std::logic_error("pixels with data that are not the image's");
    if (const std::string fault = exr_metadata_fault(read.metadata, image.width, image.height);
        !fault.empty())
        throw std::logic_error("metadata that no container takes: " + fault);
}

// A format of imgmesh-codecs: what the program does with a job, and imgmesh before it.
bool feed_codecs(const DecodeTask& task, std::span<const std::uint8_t> bytes) {
    static const bool prepared = (prepare_oiio(), true);
    static_cast<void>(prepared);
    if (task.claim.format == PictureFormat::kHeif) hevc_code_points(bytes);
    return accepts([&] {
        if (task.claim.width != 0 || task.claim.height != 0)
            check_size(task.path, task.claim.width, task.claim.height,
                       std::max<std::int64_t>(task.claim.channels, 1), task.limits);
        std::vector<std::uint8_t> samples;
        const auto offer = [&](const CodecPicture& picture) {
            check_size(task.path, picture.width, picture.height, picture.channels, task.limits);
            if (codec_picture_from(wire_from(picture)).channel_names != picture.channel_names)
                throw std::logic_error("a description that does not come through the wire");
            samples.resize(static_cast<std::size_t>(picture.width * picture.height * picture.channels) *
                           bytes_of_sample(picture.sample_type));
            return std::span(samples);
        };
        if (task.claim.format == PictureFormat::kHeif)
            decode_by_libheif(task, bytes, offer);
        else
            decode_by_oiio(task, bytes, offer);
    });
}

}  // namespace

bool feed_image(Target target, std::span<const std::uint8_t> bytes) {
    const std::string name = target == Target::kTga ? "fuzz.tga" : "fuzz";
    PictureClaim claim;
    if (!accepts([&] { claim = probe_picture(name, bytes); }) || claim.format != format_of(target))
        return false;
    ReadImageOptions options = usual_options();
    if (target >= Target::kGif && target <= Target::kHeif)
        return feed_codecs({name, claim, options.limits}, bytes);
    if (target == Target::kTga) {  // which its name tells
        std::vector<std::uint8_t> copy(bytes.begin(), bytes.end());
        return accepts([&] { decode_picture(name, copy, options); });
    }
    const MemoryFile file(bytes);
    const bool accepted = accepts([&] { check_image(read_image_file(file.path(), options)); });
    // Numbers are read in ways of their own.
    options.values = true;
    options.nodata = 0;
    options.non_finite = NonFinite::kNearest;
    accepts([&] { check_image(read_image_file(file.path(), options)); });
    if (target == Target::kExr) {
        options = usual_options();
        options.part = "1";
        options.layer = "a";
        options.channels.emplace();
        options.non_finite = NonFinite::kZero;
        accepts([&] { check_image(read_image_file(file.path(), options)); });
    }
    return accepted;
}

// Grey, RGB and ink: a profile is for one of them.
bool feed_profile(std::span<const std::uint8_t> bytes) {
    bool accepted = true;
    for (const int channels : {1, 3, 4}) {
        Image image = make_image(3, 2, channels);
        for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = static_cast<float>(i % 8) / 7;
        if (channels == 4) image.channel_names = {"C", "M", "Y", "K"};
        StatedColor color;
        color.icc.assign(bytes.begin(), bytes.end());
        color.inks = channels == 4;
        std::vector<std::string> warnings;
        accepted = accepts([&] { settle_color(color, {}, image, warnings); }) && accepted;
        for (const float sample : image.data)
            if (!std::isfinite(sample)) throw std::logic_error("a colour that is not finite");
    }
    return accepted;
}

}  // namespace imgmesh::fuzz
