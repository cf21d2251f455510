#include "formats/exr_layers.h"

#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <half.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "formats/exr_header.h"
#include "formats/finding_codes.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

constexpr const char* kVersionName = "imgmesh:version";
constexpr const char* kTopologyName = "imgmesh:topology";
constexpr const char* kVersion = "1.0";
constexpr const char *kFace = "face.id", *kU = "bary.u", *kV = "bary.v", *kVisits = "visit.count";
// Deflate never packs more than this many bytes into one.
constexpr std::uint64_t kMaxDeflateRatio = 1032;
constexpr int kMaxTileSide = 1024;

class MemoryOutput : public Imf::OStream {
  public:
    MemoryOutput() : OStream("layers") {}
    void write(const char* data, int count) override {
        const std::size_t end = position_ + static_cast<std::size_t>(count);
        if (end > bytes.size()) bytes.resize(end);
        std::memcpy(bytes.data() + position_, data, static_cast<std::size_t>(count));
        position_ = end;
    }
    std::uint64_t tellp() override { return position_; }
    void seekp(std::uint64_t position) override { position_ = position; }

    std::vector<std::uint8_t> bytes;

  private:
    std::size_t position_ = 0;
};

class MemoryInput : public Imf::IStream {
  public:
    explicit MemoryInput(std::span<const std::uint8_t> bytes) : IStream("layers"), bytes_(bytes) {}
    bool read(char* out, int count) override {
        const auto wanted = static_cast<std::size_t>(count);
        if (count < 0 || position_ > bytes_.size() || wanted > bytes_.size() - position_)
            throw std::runtime_error("unexpected end");
        std::memcpy(out, bytes_.data() + position_, wanted);
        position_ += wanted;
        return position_ < bytes_.size();
    }
    std::uint64_t tellg() override { return position_; }
    void seekg(std::uint64_t position) override { position_ = position; }

  private:
    std::span<const std::uint8_t> bytes_;
    std::uint64_t position_ = 0;
};

bool on_grid(const PixelCoord& c, float step) {
    const float u = c.u / step, v = c.v / step;  // exact: a power of two
    return u == std::floor(u) && v == std::floor(v);
}

bool in_simplex(const PixelCoord& c) {
    // In double, where the sum of two floats in [0, 1] that are 1 together is never rounded to 1 from above.
    return c.u >= 0 && c.v >= 0 && double(c.u) + double(c.v) <= 1;
}

void check_writable(const LayerPart& part) {
    const float step = part.map.precision == WeightPrecision::kHalf ? kHalfWeightStep : kFloatWeightStep;
    for (const PixelCoord& c : part.map.coords)
        if (!in_simplex(c) || !on_grid(c, step) || (c.face == kNone && (c.u != 0 || c.v != 0)))
            throw Error(ErrorCode::kInternal, cat("cannot store the weights (", c.u, ",", c.v, ") of face ",
                                                  c.face, ": outside the simplex or no multiples of ", step));
}

// A slice over one member of an array of structures of `stride` bytes.
Imf::Slice slice(Imf::PixelType type, const void* first, std::size_t stride, int width) {
    return Imf::Slice(type, static_cast<char*>(const_cast<void*>(first)), stride,
                      stride * static_cast<std::size_t>(width));
}

Imf::Header header_of(const LayerPart& part) {
    Imf::Header header(part.map.width, part.map.height);
    header.setName(part.name);
    header.setType(Imf::SCANLINEIMAGE);
    header.compression() = Imf::ZIP_COMPRESSION;
    header.insert(kVersionName, Imf::StringAttribute(kVersion));
    if (!part.topology.empty()) header.insert(kTopologyName, Imf::StringAttribute(part.topology));
    const Imf::PixelType weight = part.map.precision == WeightPrecision::kHalf ? Imf::HALF : Imf::FLOAT;
    header.channels().insert(kFace, Imf::Channel(Imf::UINT));
    header.channels().insert(kU, Imf::Channel(weight));
    header.channels().insert(kV, Imf::Channel(weight));
    if (!part.visits.empty()) header.channels().insert(kVisits, Imf::Channel(Imf::UINT));
    return header;
}

void write_part(Imf::MultiPartOutputFile& file, int index, const LayerPart& part) {
    const PixelMap& map = part.map;
    const int width = map.width;
    Imf::FrameBuffer frame;
    frame.insert(kFace, slice(Imf::UINT, &map.coords[0].face, sizeof(PixelCoord), width));
    std::vector<std::array<half, 2>> halves;
    if (map.precision == WeightPrecision::kHalf) {
        halves.reserve(map.coords.size());
        for (const PixelCoord& c : map.coords) halves.push_back({half(c.u), half(c.v)});
        frame.insert(kU, slice(Imf::HALF, &halves[0][0], sizeof(halves[0]), width));
        frame.insert(kV, slice(Imf::HALF, &halves[0][1], sizeof(halves[0]), width));
    } else {
        frame.insert(kU, slice(Imf::FLOAT, &map.coords[0].u, sizeof(PixelCoord), width));
        frame.insert(kV, slice(Imf::FLOAT, &map.coords[0].v, sizeof(PixelCoord), width));
    }
    if (!part.visits.empty()) frame.insert(kVisits, slice(Imf::UINT, part.visits.data(), sizeof(Id), width));
    Imf::OutputPart out(file, index);
    out.setFrameBuffer(frame);
    out.writePixels(map.height);
}

void check_header(const Imf::Header& header, const std::string& name, const ExpectedLayers& expected) {
    if (header.hasType() && header.type() != Imf::SCANLINEIMAGE && header.type() != Imf::TILEDIMAGE)
        refuse("layers.type", cat("part ", name, " is of type ", header.type()));
    if (header.hasTileDescription()) {
        const Imf::TileDescription& tiles = header.tileDescription();
        if (tiles.mode != Imf::ONE_LEVEL || tiles.xSize > kMaxTileSide || tiles.ySize > kMaxTileSide)
            refuse("layers.type", cat("part ", name, " has tiles of ", tiles.xSize, "x", tiles.ySize,
                                      " or of several levels, at most ", kMaxTileSide, " and one"));
    }
    const Imath::Box2i window({0, 0}, {expected.width - 1, expected.height - 1});
    for (const Imath::Box2i& found : {header.dataWindow(), header.displayWindow()})
        if (found != window)
            refuse("layers.window",
                   cat("part ", name, " has the window (", found.min.x, ",", found.min.y, ")-(", found.max.x,
                       ",", found.max.y, "), expected (0,0)-(", window.max.x, ",", window.max.y, ")"));
    const Imf::Compression compression = header.compression();
    if (compression != Imf::NO_COMPRESSION && compression != Imf::ZIPS_COMPRESSION &&
        compression != Imf::ZIP_COMPRESSION)
        refuse("layers.compression", cat("part ", name, " has compression ", int{compression}));

    bool face = false, u = false, v = false;
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
        const std::string_view channel = it.name();
        const Imf::Channel& c = it.channel();
        const bool is_weight = channel == kU || channel == kV;
        const bool is_id = channel == kFace || channel == kVisits;
        const bool right_type = is_id ? c.type == Imf::UINT : is_weight && c.type != Imf::UINT;
        if (!right_type || c.xSampling != 1 || c.ySampling != 1)
            refuse("layers.channels",
                   cat("channel ", channel, " of part ", name, " is unknown, of another type or subsampled"));
        face = face || channel == kFace;
        u = u || channel == kU;
        v = v || channel == kV;
    }
    if (!face || !u || !v)
        refuse("layers.channels", cat("part ", name, " lacks one of ", kFace, ", ", kU, ", ", kV));
}

// Checks what was read, and puts weights of any origin on the grid.
void finish_part(LayerPart& part, bool stored_as_half, std::uint64_t faces, bool has_mask) {
    bool all_on_half_grid = stored_as_half;
    const auto where = [&](std::size_t i) {
        const auto width = static_cast<std::size_t>(part.map.width);
        return cat("(", i % width, ",", i / width, ") of ", part.name);
    };
    for (std::size_t i = 0; i < part.map.coords.size(); ++i) {
        PixelCoord& c = part.map.coords[i];
        if (!in_simplex(c))
            refuse("layers.weights", cat("weights u = ", c.u, ", v = ", c.v, " at ", where(i),
                                         ", expected u, v >= 0 and u + v <= 1"));
        if (c.face == kNone) {
            if (!has_mask)
                refuse("layers.mask", cat("no face at ", where(i), ", but the picture has no mask"));
            if (c.u != 0 || c.v != 0) refuse("layers.mask", cat("weights outside the mask at ", where(i)));
        } else if (c.face >= faces) {
            refuse("layers.face_range",
                   cat("face.id ", c.face, " at ", where(i), ", the mesh has ", faces, " faces"));
        }
        // Nothing changes for weights on the grid, but for negative zeros.
        c.u = std::floor(c.u / kFloatWeightStep) * kFloatWeightStep + 0.0f;
        c.v = std::floor(c.v / kFloatWeightStep) * kFloatWeightStep + 0.0f;
        all_on_half_grid = all_on_half_grid && on_grid(c, kHalfWeightStep);
    }
    part.map.precision = all_on_half_grid ? WeightPrecision::kHalf : WeightPrecision::kFloat;
}

LayerPart read_part(Imf::MultiPartInputFile& file, int index, const ExpectedLayers& expected,
                    std::size_t which) {
    const Imf::Header& header = file.header(index);
    const std::size_t pixels =
        static_cast<std::size_t>(expected.width) * static_cast<std::size_t>(expected.height);
    LayerPart part{
        expected.parts[which], {expected.width, expected.height, {}, WeightPrecision::kFloat}, {}, {}};
    part.map.coords.resize(pixels);
    Imf::FrameBuffer frame;  // OpenEXR turns HALF into FLOAT
    frame.insert(kFace, slice(Imf::UINT, &part.map.coords[0].face, sizeof(PixelCoord), expected.width));
    frame.insert(kU, slice(Imf::FLOAT, &part.map.coords[0].u, sizeof(PixelCoord), expected.width));
    frame.insert(kV, slice(Imf::FLOAT, &part.map.coords[0].v, sizeof(PixelCoord), expected.width));
    if (header.channels().findChannel(kVisits)) {
        part.visits.resize(pixels);
        frame.insert(kVisits, slice(Imf::UINT, part.visits.data(), sizeof(Id), expected.width));
    }
    if (const auto* topology = header.findTypedAttribute<Imf::StringAttribute>(kTopologyName))
        part.topology = topology->value();
    Imf::InputPart in(file, index);
    in.setFrameBuffer(frame);
    in.readPixels(0, expected.height - 1);
    const bool stored_as_half =
        header.channels()[kU].type == Imf::HALF && header.channels()[kV].type == Imf::HALF;
    finish_part(part, stored_as_half, expected.faces[which], expected.has_mask);
    return part;
}

std::vector<LayerPart> read_parts(std::span<const std::uint8_t> bytes, const ExpectedLayers& expected) {
    MemoryInput stream(bytes);
    Imf::MultiPartInputFile file(stream, /*numThreads=*/0, /*reconstructChunkOffsetTable=*/false);
    if (file.parts() != static_cast<int>(expected.parts.size()))
        refuse("layers.parts", cat("the EXR has ", file.parts(), " parts, expected ", expected.parts.size()));
    const auto* version = file.header(0).findTypedAttribute<Imf::StringAttribute>(kVersionName);
    if (!version || !version->value().starts_with("1."))
        refuse("layers.version",
               cat(kVersionName, " is ", version ? version->value() : "missing", ", expected 1.x"));
    std::vector<LayerPart> parts;
    for (std::size_t which = 0; which < expected.parts.size(); ++which) {
        const std::string& name = expected.parts[which];
        int index = 0;
        while (index < file.parts() && !(file.header(index).hasName() && file.header(index).name() == name))
            ++index;
        if (index == file.parts()) refuse("layers.parts", cat("the EXR has no part ", name));
        check_header(file.header(index), name, expected);
        parts.push_back(read_part(file, index, expected, which));
    }
    return parts;
}

}  // namespace

std::vector<std::uint8_t> encode_exr_layers(const std::vector<LayerPart>& parts) {
    std::vector<Imf::Header> headers;
    for (const LayerPart& part : parts) {
        check_writable(part);
        headers.push_back(header_of(part));
    }
    try {
        MemoryOutput stream;
        {
            Imf::MultiPartOutputFile file(stream, headers.data(), static_cast<int>(headers.size()),
                                          /*overrideSharedAttributes=*/false, /*numThreads=*/0);
            for (std::size_t i = 0; i < parts.size(); ++i) write_part(file, static_cast<int>(i), parts[i]);
        }  // the chunk tables are written on destruction
        return std::move(stream.bytes);
    } catch (const Iex::BaseExc& error) {
        throw Error(ErrorCode::kInternal, cat("OpenEXR cannot encode the layers: ", error.what()));
    }
}

std::vector<LayerPart> decode_exr_layers(std::span<const std::uint8_t> bytes,
                                         const ExpectedLayers& expected) {
    check_exr_header(bytes, static_cast<int>(expected.parts.size()));
    // An id and two halves are 8 bytes a pixel. This bounds all memory by the bytes that are really there.
    const std::uint64_t pixel_bytes = 8 * static_cast<std::uint64_t>(expected.width) *
                                      static_cast<std::uint64_t>(expected.height) * expected.parts.size();
    if (pixel_bytes / kMaxDeflateRatio > bytes.size())
        refuse("layers.size", cat("the EXR has ", bytes.size(), " bytes, too few for ", expected.parts.size(),
                                  " levels of ", expected.width, "x", expected.height, " pixels"));
    try {
        return read_parts(bytes, expected);
    } catch (const FindingError&) {
        throw;
    } catch (const std::exception& error) {  // OpenEXR's own, and what std containers throw for its sizes
        std::string text = error.what();
        std::replace(text.begin(), text.end(), '\n', ' ');
        refuse("layers.data", cat("OpenEXR cannot read the layers: ", text));
    }
}

}  // namespace imgmesh
