#include "formats/exr/exr_parts.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>

#include "formats/exr/memory_output.h"
#include "formats/files/atomic_file.h"
#include "formats/files/library_error.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

// All parts of a file have one display window; a part's image is its data window.
Imf::Header header_of(const NamedImage& part, const Image& shown) {
    const auto window = [](const Image& image) {
        return Imath::Box2i({0, 0}, {image.width - 1, image.height - 1});
    };
    Imf::Header header(window(shown), window(part.image), 1, {0, 0}, 1, Imf::INCREASING_Y,
                       Imf::ZIP_COMPRESSION);
    header.setName(part.name);
    header.setType(Imf::SCANLINEIMAGE);
    for (const std::string& channel : part.image.channel_names)
        header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
    return header;
}

void write_part(Imf::MultiPartOutputFile& file, int number, const Image& image) {
    Imf::FrameBuffer buffer;
    const std::size_t stride = static_cast<std::size_t>(image.channels) * sizeof(float);
    for (std::size_t c = 0; c < image.channel_names.size(); ++c)
        buffer.insert(image.channel_names[c],
                      Imf::Slice::Make(Imf::FLOAT, image.data.data() + c, {0, 0}, image.width, image.height,
                                       stride, stride * static_cast<std::size_t>(image.width)));
    Imf::OutputPart part(file, number);
    part.setFrameBuffer(buffer);
    part.writePixels(image.height);
}

template <typename Value>
void write_channel(const std::string& path, const std::string& channel, Imf::PixelType type, int width,
                   int height, std::span<const Value> values, bool overwrite) {
    AtomicFile target(path, overwrite);
    MemoryOutput memory;
    translate_errors(ErrorKind::kIo, cat(path, ": cannot write the EXR"), [&] {
        Imf::Header header(width, height, 1, {0, 0}, 1, Imf::INCREASING_Y, Imf::ZIP_COMPRESSION);
        header.channels().insert(channel, Imf::Channel(type));
        Imf::FrameBuffer buffer;
        buffer.insert(channel, Imf::Slice::Make(type, values.data(), {0, 0}, width, height));
        Imf::OutputFile file(memory, header, /*numThreads=*/0);
        file.setFrameBuffer(buffer);
        file.writePixels(height);
    });
    target.write(memory.bytes);
    target.commit();
}

}  // namespace

void write_exr_channel(const std::string& path, const std::string& channel, int width, int height,
                       std::span<const Id> values, bool overwrite) {
    write_channel(path, channel, Imf::UINT, width, height, values, overwrite);
}

void write_exr_channel(const std::string& path, const std::string& channel, int width, int height,
                       std::span<const float> values, bool overwrite) {
    write_channel(path, channel, Imf::FLOAT, width, height, values, overwrite);
}

void write_exr_parts(const std::string& path, const std::vector<NamedImage>& parts, bool overwrite) {
    AtomicFile target(path, overwrite);
    MemoryOutput memory;
    translate_errors(ErrorKind::kIo, cat(path, ": cannot write"), [&] {
        std::vector<Imf::Header> headers;
        for (const NamedImage& part : parts) headers.push_back(header_of(part, parts.front().image));
        Imf::MultiPartOutputFile file(memory, headers.data(), static_cast<int>(headers.size()), false,
                                      /*numThreads=*/0);
        for (std::size_t i = 0; i < parts.size(); ++i) write_part(file, static_cast<int>(i), parts[i].image);
    });
    target.write(memory.bytes);
    target.commit();
}

}  // namespace imgmesh
