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
#include "formats/exr_part_checks.h"
#include "formats/findings.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

constexpr const char* kVersionName = "imgmesh:version";
constexpr const char* kTopologyName = "imgmesh:topology";
constexpr const char* kVersion = "1.0";
// Deflate never packs more than this many bytes into one.
constexpr std::uint64_t kMaxDeflateRatio = 1032;

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

LayerPart read_part(Imf::MultiPartInputFile& file, int index, const ExpectedLayers& expected,
                    std::size_t which, Findings& findings) {
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
    else
        findings.add("layers.unbound", cat("part ", part.name, " has no ", kTopologyName),
                     at_part(part.name));
    Imf::InputPart in(file, index);
    in.setFrameBuffer(frame);
    in.readPixels(0, expected.height - 1);
    const bool stored_as_half =
        header.channels()[kU].type == Imf::HALF && header.channels()[kV].type == Imf::HALF;
    finish_part(part, stored_as_half, expected.faces[which], expected.has_mask, findings);
    return part;
}

std::vector<LayerPart> read_parts(std::span<const std::uint8_t> bytes, const ExpectedLayers& expected,
                                  Findings& findings) {
    MemoryInput stream(bytes);
    Imf::MultiPartInputFile file(stream, /*numThreads=*/0, /*reconstructChunkOffsetTable=*/false);
    if (file.parts() != static_cast<int>(expected.parts.size()))
        refuse("layers.parts", cat("the EXR has ", file.parts(), " parts, expected ", expected.parts.size()));
    const auto* version = file.header(0).findTypedAttribute<Imf::StringAttribute>(kVersionName);
    if (!version || !version->value().starts_with("1."))
        findings.add("layers.version",
                     cat(kVersionName, " is ", version ? version->value() : "missing", ", expected 1.x"));
    std::vector<LayerPart> parts(expected.parts.size());
    for (std::size_t which = 0; which < expected.parts.size(); ++which) {
        const std::string& name = expected.parts[which];
        parts[which].name = name;
        int index = 0;
        while (index < file.parts() && !(file.header(index).hasName() && file.header(index).name() == name))
            ++index;
        if (index == file.parts()) {
            findings.add("layers.parts", cat("the EXR has no part ", name), at_part(name));
            continue;
        }
        const std::size_t before = findings.errors();
        check_part_header(file.header(index), name, expected, findings);
        if (findings.errors() > before) continue;
        try {
            LayerPart part = read_part(file, index, expected, which, findings);
            if (findings.errors() == before) parts[which] = std::move(part);
        } catch (const Iex::BaseExc& error) {
            findings.add("layers.data", cat("OpenEXR cannot read part ", name, ": ", error.what()),
                         at_part(name));
        }
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

std::vector<LayerPart> decode_exr_layers(std::span<const std::uint8_t> bytes, const ExpectedLayers& expected,
                                         Findings& findings) {
    check_exr_header(bytes, static_cast<int>(expected.parts.size()));
    // An id and two halves are 8 bytes a pixel. This bounds all memory by the bytes that are really there.
    const std::uint64_t pixel_bytes = 8 * static_cast<std::uint64_t>(expected.width) *
                                      static_cast<std::uint64_t>(expected.height) * expected.parts.size();
    if (pixel_bytes / kMaxDeflateRatio > bytes.size())
        refuse("layers.size", cat("the EXR has ", bytes.size(), " bytes, too few for ", expected.parts.size(),
                                  " levels of ", expected.width, "x", expected.height, " pixels"));
    try {
        return read_parts(bytes, expected, findings);
    } catch (const FindingError&) {
        throw;
    } catch (const std::exception& error) {  // OpenEXR's own, and what std containers throw for its sizes
        std::string text = error.what();
        std::replace(text.begin(), text.end(), '\n', ' ');
        refuse("layers.data", cat("OpenEXR cannot read the layers: ", text));
    }
}

std::vector<LayerPart> decode_exr_layers(std::span<const std::uint8_t> bytes,
                                         const ExpectedLayers& expected) {
    Findings findings = Findings::strict();
    return decode_exr_layers(bytes, expected, findings);
}

}  // namespace imgmesh
