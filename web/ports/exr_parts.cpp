// EXR files of one and of several parts, without OpenEXR.
#include "formats/exr/exr_parts.h"

#include <algorithm>
#include <cstring>
#include <numeric>

#include "formats/exr/exr_output.h"
#include "formats/exr/zip_blocks.h"
#include "formats/files/atomic_file.h"

namespace imgmesh {
namespace {

using Bytes = std::vector<std::uint8_t>;

// A part to write: `values` has those of `channels` at each pixel.
struct Part {
    ExrPartHeader header;
    int width, height;
    const std::uint8_t* values;           // 4 bytes each
    std::vector<std::size_t> channel_at;  // of the header's channels, among those of a pixel
};

void write_blocks(ExrOutput& file, std::size_t number, const Part& part) {
    ZipPacker packer;
    Bytes block;
    const std::size_t width = static_cast<std::size_t>(part.width), step = 4 * part.channel_at.size();
    for (int top = 0; top < part.height; top += kExrZipRows) {
        const int bottom = std::min(part.height, top + kExrZipRows);
        block.resize(step * width * static_cast<std::size_t>(bottom - top));
        std::uint8_t* out = block.data();
        for (int y = top; y < bottom; ++y)
            for (const std::size_t at : part.channel_at) {
                const std::uint8_t* in = part.values + step * width * static_cast<std::size_t>(y) + 4 * at;
                for (std::size_t x = 0; x < width; ++x, in += step, out += 4) std::memcpy(out, in, 4);
            }
        file.write_block(number, top, packer.pack(block));
    }
}

void write_file(const std::string& path, const std::vector<Part>& parts, bool overwrite) {
    AtomicFile target(path, overwrite);
    Bytes bytes;
    ExrOutput file(bytes);
    for (const Part& part : parts) file.add_part(part.header);
    for (std::size_t i = 0; i < parts.size(); ++i) write_blocks(file, i, parts[i]);
    file.finish();
    target.write(bytes);
    target.commit();
}

ExrWindow window_of(int width, int height) {
    return {0, 0, width - 1, height - 1};
}

template <typename Value>
void write_channel(const std::string& path, const std::string& channel, ExrSample type, int width, int height,
                   std::span<const Value> values, bool overwrite) {
    static_assert(sizeof(Value) == 4);
    Part part{{}, width, height, reinterpret_cast<const std::uint8_t*>(values.data()), {0}};
    part.header.data = part.header.shown = window_of(width, height);
    part.header.channels = {{channel, type}};
    write_file(path, {part}, overwrite);
}

}  // namespace

void write_exr_parts(const std::string& path, const std::vector<NamedImage>& images, bool overwrite) {
    const Image& shown = images.front().image;
    std::vector<Part> parts;
    for (const NamedImage& named : images) {
        const Image& image = named.image;
        Part part{
            {}, image.width, image.height, reinterpret_cast<const std::uint8_t*>(image.data.data()), {}};
        part.header.name = named.name;
        part.header.data = window_of(image.width, image.height);
        part.header.shown = window_of(shown.width, shown.height);
        part.channel_at.resize(image.channel_names.size());
        std::iota(part.channel_at.begin(), part.channel_at.end(), std::size_t{0});
        std::ranges::sort(part.channel_at, {}, [&](std::size_t c) { return image.channel_names[c]; });
        for (const std::size_t c : part.channel_at)
            part.header.channels.push_back({image.channel_names[c], ExrSample::kFloat});
        parts.push_back(std::move(part));
    }
    write_file(path, parts, overwrite);
}

void write_exr_channel(const std::string& path, const std::string& channel, int width, int height,
                       std::span<const Id> values, bool overwrite) {
    write_channel(path, channel, ExrSample::kUint, width, height, values, overwrite);
}

void write_exr_channel(const std::string& path, const std::string& channel, int width, int height,
                       std::span<const float> values, bool overwrite) {
    write_channel(path, channel, ExrSample::kFloat, width, height, values, overwrite);
}

}  // namespace imgmesh
