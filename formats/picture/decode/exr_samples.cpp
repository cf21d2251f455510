#include "formats/picture/decode/exr_samples.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfTileDescription.h>
#include <OpenEXR/ImfTiledInputPart.h>

#include <algorithm>
#include <bit>

#include "formats/picture/decode/exr_chroma.h"

namespace imgmesh {
namespace {

using Imath::Box2i;
using Imath::V2i;

std::int64_t length(int first, int last) {
    return std::int64_t{last} - first + 1;
}

std::int64_t lines_of_chunk(Imf::Compression compression) {
    switch (compression) {
        case Imf::ZIP_COMPRESSION:
        case Imf::PXR24_COMPRESSION:
            return 16;
        case Imf::PIZ_COMPRESSION:
        case Imf::B44_COMPRESSION:
        case Imf::B44A_COMPRESSION:
        case Imf::DWAA_COMPRESSION:
            return 32;
        case Imf::DWAB_COMPRESSION:
            return 256;
        default:
            return 1;
    }
}

// Samples of every channel, as the bits of floats, or integers. OpenEXR fills them.
using Planes = std::vector<std::vector<std::uint32_t>>;
constexpr auto kSampleBytes = static_cast<std::ptrdiff_t>(sizeof(std::uint32_t));

Imf::PixelType read_as(const ExrChannel& channel) {
    return channel.type == Imf::UINT ? Imf::UINT : Imf::FLOAT;
}

}  // namespace

ExrBlock exr_block(const Imf::Header& header) {
    ExrBlock block;
    std::int64_t pixel = 0;
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
        ++block.channels;
        pixel += it.channel().type == Imf::HALF ? 2 : 4;
    }
    block.tile = header.hasTileDescription();
    if (block.tile) {
        block.width = header.tileDescription().xSize;
        block.height = header.tileDescription().ySize;
    } else {
        block.width = length(header.dataWindow().min.x, header.dataWindow().max.x);
        block.height = lines_of_chunk(header.compression());
    }
    block.bytes = block.width * block.height * pixel;
    return block;
}

// A part in either form.
struct ExrSamples::Blocks {
    Blocks(const ExrChoice& chosen, const Box2i& window) : choice(chosen), stored(window) {}
    virtual ~Blocks() = default;
    Blocks(const Blocks&) = delete;
    Blocks& operator=(const Blocks&) = delete;

    virtual void read(const Box2i& wanted, const V2i& origin, Image& image, std::vector<char>& exact) = 0;

    // Copies a row of a plane, whose first sample is at column `left`, into what the image has of row y.
    void copy_row(std::size_t c, const std::uint32_t* row, int left, int right, int y, const V2i& origin,
                  Image& image, std::vector<char>& exact) const {
        constexpr std::uint32_t kExact = 1u << 24;
        if (y < origin.y || y - origin.y >= image.height) return;
        const bool integers = choice.channels[c].type == Imf::UINT;
        const int first = std::max(left, origin.x), last = static_cast<int>(std::min<std::int64_t>(
                                                        right, std::int64_t{origin.x} + image.width - 1));
        for (int x = first; x <= last; ++x) {
            const std::uint32_t bits = row[x - left];
            image.pixel(x - origin.x, y - origin.y)[c] =
                integers ? static_cast<float>(bits) : std::bit_cast<float>(bits);
            if (integers && bits >= kExact) exact[c] = 0;
        }
    }

    const ExrChoice& choice;
    const Box2i stored;
    Planes planes;
};

struct ExrSamples::Lines : Blocks {
    Lines(Imf::MultiPartInputFile& file, const ExrChoice& chosen)
        : Blocks(chosen, file.header(chosen.part).dataWindow()), part(file, chosen.part) {
        for (const ExrChannel& channel : choice.channels) {
            auto& row = planes.emplace_back(
                channel.full.empty() ? 0 : static_cast<std::size_t>(length(stored.min.x, stored.max.x)));
            // OpenEXR wants the address of pixel (0, 0), wherever the window is. All rows are the same.
            if (!channel.full.empty())
                buffer.insert(channel.full,
                              Imf::Slice(read_as(channel),
                                         reinterpret_cast<char*>(row.data()) - kSampleBytes * stored.min.x,
                                         kSampleBytes, 0));
        }
    }

    void read(const Box2i& wanted, const V2i& origin, Image& image, std::vector<char>& exact) override {
        if (buffer.begin() != buffer.end()) {
            part.setFrameBuffer(buffer);
            for (int y = wanted.min.y; y <= wanted.max.y; ++y) {
                part.readPixels(y);
                for (std::size_t c = 0; c < planes.size(); ++c)
                    if (!planes[c].empty())
                        copy_row(c, planes[c].data(), stored.min.x, stored.max.x, y, origin, image, exact);
            }
        }
        if (!choice.luma.empty()) read_colors(wanted, origin, image, exact);
    }

    void read_colors(const Box2i& wanted, const V2i& origin, Image& image, std::vector<char>& exact) {
        constexpr const char* kNames[] = {"R", "G", "B"};
        std::vector<std::uint32_t> row(static_cast<std::size_t>(length(stored.min.x, stored.max.x)));
        read_exr_chroma(part, choice, wanted.min.y, wanted.max.y, [&](int y, const float* rgb) {
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t c = 0; c < choice.channels.size(); ++c) {
                    if (!choice.channels[c].full.empty() || choice.channels[c].name != kNames[k]) continue;
                    for (std::size_t x = 0; x < row.size(); ++x)
                        row[x] = std::bit_cast<std::uint32_t>(rgb[3 * x + k]);
                    copy_row(c, row.data(), stored.min.x, stored.max.x, y, origin, image, exact);
                }
        });
    }

    Imf::InputPart part;
    Imf::FrameBuffer buffer;
};

struct ExrSamples::Tiles : Blocks {
    Tiles(Imf::MultiPartInputFile& file, const ExrChoice& chosen)
        : Blocks(chosen, file.header(chosen.part).dataWindow()),
          part(file, chosen.part),
          width(part.tileXSize()),
          height(part.tileYSize()) {
        Imf::FrameBuffer buffer;
        for (const ExrChannel& channel : choice.channels) {
            auto& tile = planes.emplace_back(std::size_t{width} * height);
            buffer.insert(channel.full, Imf::Slice(read_as(channel), reinterpret_cast<char*>(tile.data()),
                                                   kSampleBytes, kSampleBytes * width, 1, 1, 0,
                                                   /*xTileCoords=*/true, /*yTileCoords=*/true));
        }
        part.setFrameBuffer(buffer);
    }

    void read(const Box2i& wanted, const V2i& origin, Image& image, std::vector<char>& exact) override {
        const auto tile = [](int at, int first, unsigned size) {
            return static_cast<int>((std::int64_t{at} - first) / size);
        };
        const int last_column = tile(wanted.max.x, stored.min.x, width),
                  last_row = tile(wanted.max.y, stored.min.y, height);
        for (int row = tile(wanted.min.y, stored.min.y, height); row <= last_row; ++row)
            for (int column = tile(wanted.min.x, stored.min.x, width); column <= last_column; ++column) {
                part.readTile(column, row, 0, 0);
                copy_tile(part.dataWindowForTile(column, row, 0, 0), origin, image, exact);
            }
    }

    void copy_tile(const Box2i& box, const V2i& origin, Image& image, std::vector<char>& exact) const {
        for (int y = box.min.y; y <= box.max.y; ++y)
            for (std::size_t c = 0; c < planes.size(); ++c)
                copy_row(c, planes[c].data() + std::size_t{width} * static_cast<std::size_t>(y - box.min.y),
                         box.min.x, box.max.x, y, origin, image, exact);
    }

    Imf::TiledInputPart part;
    unsigned width, height;
};

ExrSamples::ExrSamples(Imf::MultiPartInputFile& file, const ExrChoice& choice) : choice_(choice) {
    if (file.header(choice.part).hasTileDescription())
        blocks_ = std::make_unique<Tiles>(file, choice);
    else
        blocks_ = std::make_unique<Lines>(file, choice);
}

ExrSamples::~ExrSamples() = default;

std::vector<char> ExrSamples::read(const Box2i& wanted, const V2i& origin, Image& image) {
    std::vector<char> exact(choice_.channels.size(), 1);
    blocks_->read(wanted, origin, image, exact);
    return exact;
}

}  // namespace imgmesh
