#include "formats/exr/exr_input.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <ImfTileDescriptionAttribute.h>

#include "formats/exr/exr_part_checks.h"
#include "formats/exr/memory_input.h"

namespace imgmesh {
namespace {

ExrWindow window_of(const Imath::Box2i& box) {
    return {box.min.x, box.min.y, box.max.x, box.max.y};
}

std::optional<std::string> text_attribute(const Imf::Header& header, const char* name) {
    const auto* found = header.findTypedAttribute<Imf::StringAttribute>(name);
    return found ? std::optional(found->value()) : std::nullopt;
}

ExrPartHeader part_header(const Imf::Header& header) {
    ExrPartHeader part;
    if (header.hasName()) part.name = header.name();
    if (header.hasType()) part.type = header.type();
    if (header.hasTileDescription()) {
        const Imf::TileDescription& tiles = header.tileDescription();
        part.tiles = {tiles.xSize, tiles.ySize, tiles.mode == Imf::ONE_LEVEL};
    }
    part.data = window_of(header.dataWindow());
    part.shown = window_of(header.displayWindow());
    part.compression = header.compression();
    for (auto at = header.channels().begin(); at != header.channels().end(); ++at) {
        const Imf::Channel& c = at.channel();
        part.channels.push_back({at.name(), ExrSample(int{c.type}), c.xSampling, c.ySampling, c.pLinear});
    }
    part.version = text_attribute(header, kVersionName);
    part.topology = text_attribute(header, kTopologyName);
    return part;
}

// A slice over one member of an array of structures of `stride` bytes.
Imf::Slice slice(Imf::PixelType type, const void* first, std::size_t stride, int width) {
    return Imf::Slice(type, static_cast<char*>(const_cast<void*>(first)), stride,
                      stride * static_cast<std::size_t>(width));
}

template <typename Work>
auto readable(Work&& work) {
    try {
        return work();
    } catch (const Iex::BaseExc& error) {
        throw ExrDataError(error.what());
    }
}

}  // namespace

class ExrInput::File {
  public:
    explicit File(std::span<const std::uint8_t> bytes)
        : stream_("layers", bytes), file_(stream_, /*numThreads=*/0, /*reconstructChunkOffsetTable=*/false) {}

    Imf::MultiPartInputFile& file() { return file_; }
    Imf::InputPart& part(std::size_t index) {
        if (!part_ || index != index_)
            part_ = std::make_unique<Imf::InputPart>(file_, static_cast<int>(index));
        index_ = index;
        return *part_;
    }

  private:
    MemoryInput stream_;
    Imf::MultiPartInputFile file_;
    std::unique_ptr<Imf::InputPart> part_;
    std::size_t index_ = 0;
};

ExrInput::ExrInput(std::span<const std::uint8_t> bytes) : file_(std::make_unique<File>(bytes)) {
    for (int i = 0; i < file_->file().parts(); ++i) parts_.push_back(part_header(file_->file().header(i)));
}

ExrInput::~ExrInput() = default;

std::span<const std::uint8_t> ExrInput::block(std::size_t part, int row) {
    return readable([&]() -> std::span<const std::uint8_t> {
        const char* data = nullptr;
        int size = 0;
        file_->part(part).rawPixelData(row + parts_[part].data.min_y, data, size);
        return {reinterpret_cast<const std::uint8_t*>(data), static_cast<std::size_t>(size)};
    });
}

// OpenEXR assembles tiles and converts HALF to FLOAT.
void ExrInput::read_tiles(std::size_t part, LayerPart& out) {
    readable([&] {
        const int width = out.map.width;
        Imf::FrameBuffer frame;
        frame.insert(kFace, slice(Imf::UINT, &out.map[0].face, sizeof(PixelCoord), width));
        frame.insert(kU, slice(Imf::FLOAT, &out.map[0].u, sizeof(PixelCoord), width));
        frame.insert(kV, slice(Imf::FLOAT, &out.map[0].v, sizeof(PixelCoord), width));
        if (!out.visits.empty())
            frame.insert(kVisits, slice(Imf::UINT, out.visits.data(), sizeof(Id), width));
        Imf::InputPart& in = file_->part(part);
        in.setFrameBuffer(frame);
        in.readPixels(0, out.map.height - 1);
    });
}

}  // namespace imgmesh
