// Images that OpenImageIO writes, and text that it draws.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <memory>

#include "formats/files/one_line.h"
#include "formats/picture/codecs/program/codecs.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

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

}  // namespace

void prepare_oiio() {
    // OpenImageIO's own pool would ignore the caller's limit; images of a batch run in parallel anyway.
    OIIO::attribute("threads", 1);
    OIIO::attribute("plugin_searchpath", "");
}

std::vector<std::uint8_t> encode_by_oiio(const EncodeTask& task, std::span<const std::uint8_t> samples) {
    const auto failed = [&](const std::string& reason) {
        // All happens in memory, so the library refuses only what the format cannot hold.
        return Error(ErrorKind::kBadArgument, cat(task.path, ": cannot be written: ", one_line(reason)));
    };
    const OIIO::TypeDesc stored = task.type == SampleType::kUint8    ? OIIO::TypeUInt8
                                  : task.type == SampleType::kUint16 ? OIIO::TypeUInt16
                                                                     : OIIO::TypeFloat;
    const auto count = static_cast<std::size_t>(task.width) * static_cast<std::size_t>(task.height) *
                       task.channel_names.size();
    if (samples.size() != count * bytes_of_sample(task.type))
        throw Error(ErrorKind::kInternal, "an image of a wrong size");
    OIIO::ImageSpec spec(task.width, task.height, static_cast<int>(task.channel_names.size()), stored);
    spec.channelnames = task.channel_names;
    spec.alpha_channel = task.alpha_channel;
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("DateTime", "");  // TIFF's writer would write the time, so bytes would differ
    // Not in TIFF, where it needs an EXIF directory, for which OpenImageIO cannot read its own memory back.
    if (task.say_srgb && task.writer != "tiff") spec.attribute("oiio:ColorSpace", "sRGB");
    if (!task.icc.empty())
        spec.attribute("ICCProfile", OIIO::TypeDesc(OIIO::TypeDesc::UINT8, static_cast<int>(task.icc.size())),
                       task.icc.data());

    std::vector<std::uint8_t> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(task.writer);
    if (!output)
        throw Error(ErrorKind::kUnsupported, cat(task.path, ": OpenImageIO is built without ", task.writer));
    output->set_ioproxy(&memory);
    if (!output->open(cat("memory", task.extension), spec)) throw failed(output->geterror());
    if (!output->write_image(stored, samples.data()) || !output->close()) throw failed(output->geterror());
    return bytes;
}

void draw_by_oiio(const TextTask& task, std::span<std::uint8_t> samples) {
    const OIIO::ImageSpec spec(task.width, task.height, task.channels, OIIO::TypeFloat);
    if (samples.size() != spec.image_bytes()) throw Error(ErrorKind::kInternal, "an image of a wrong size");
    OIIO::ImageBuf buffer(spec, samples.data());  // draws into the memory itself
    for (const TextLabel& label : task.labels)
        if (!OIIO::ImageBufAlgo::render_text(buffer, label.x, label.y, label.text, label.size, "DejaVuSans",
                                             {label.color.data(), 3}, oiio_align(label.align),
                                             OIIO::ImageBufAlgo::TextAlignY::Baseline))
            throw Error(ErrorKind::kUnsupported, cat("cannot draw text: ", one_line(buffer.geterror())));
}

}  // namespace imgmesh
