// The page's own reader and writer of layers (web/ports) instead of OpenEXR's: OpenEXR reads what it writes,
// it reads what OpenEXR writes, and no bytes make it crash.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <doctest/doctest.h>

#include <cstring>
#include <random>

#include "formats/exr/exr_layers.h"
#include "formats/exr/memory_input.h"
#include "formats/exr/memory_output.h"
#include "formats/findings/findings.h"

namespace imgmesh {
namespace {

using Bytes = std::vector<std::uint8_t>;

// A map whose values differ from pixel to pixel, with pixels outside the mask.
LayerPart part_of(const std::string& name, int width, int height, WeightPrecision precision, bool visits) {
    LayerPart part{name, {width, height, {}, precision}, {}, std::string(64, 'a')};
    const auto count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    const float step = precision == WeightPrecision::kHalf ? kHalfWeightStep : kFloatWeightStep;
    for (std::size_t i = 0; i < count; ++i) {
        const bool outside = i % 7 == 3;
        const auto weight = [&](std::size_t k) {
            return outside ? 0 : static_cast<float>(i * k % 200) * step;
        };
        part.map.values.push_back({outside ? kNone : static_cast<Id>(i * 31 % 1000), weight(3), weight(5)});
        if (visits) part.visits.push_back(static_cast<Id>(i));
    }
    return part;
}

ExpectedLayers expected_of(const std::vector<LayerPart>& parts) {
    ExpectedLayers expected{parts[0].map.width, parts[0].map.height, {}, {}, true};
    for (const LayerPart& part : parts) {
        expected.parts.push_back(part.name);
        expected.faces.push_back(1000);
    }
    return expected;
}

bool equal(const LayerPart& a, const LayerPart& b) {
    return a.name == b.name && a.topology == b.topology && a.visits == b.visits &&
           a.map.values == b.map.values && a.map.precision == b.map.precision;
}

const std::vector<std::vector<LayerPart>>& samples() {
    static const std::vector<std::vector<LayerPart>> all = {
        {part_of("lod0", 19, 37, WeightPrecision::kHalf, true),
         part_of("lod1", 19, 37, WeightPrecision::kHalf, false)},
        {part_of("lod0", 33, 16, WeightPrecision::kFloat, false)},
        {part_of("lod0", 4, 1, WeightPrecision::kFloat, true)}};
    return all;
}

// A map as OpenEXR itself writes it, with that compression and perhaps in tiles.
Bytes written_by_openexr(const LayerPart& part, Imf::Compression compression, bool tiled = false) {
    MemoryOutput memory;
    {
        Imf::Header header(part.map.width, part.map.height, 1, {0, 0}, 1, Imf::INCREASING_Y, compression);
        header.setName(part.name);
        header.setType(tiled ? Imf::TILEDIMAGE : Imf::SCANLINEIMAGE);
        if (tiled) header.setTileDescription({16, 16, Imf::ONE_LEVEL});
        header.insert("imgmesh:version", Imf::StringAttribute("1.0"));
        header.insert("imgmesh:topology", Imf::StringAttribute(part.topology));
        Imf::FrameBuffer frame;
        const auto add = [&](const char* name, Imf::PixelType type, const void* first) {
            header.channels().insert(name, Imf::Channel(type));
            frame.insert(name,
                         Imf::Slice(type, static_cast<char*>(const_cast<void*>(first)), sizeof(PixelCoord),
                                    sizeof(PixelCoord) * static_cast<std::size_t>(part.map.width)));
        };
        add("face.id", Imf::UINT, &part.map.values[0].face);
        add("bary.u", Imf::FLOAT, &part.map.values[0].u);
        add("bary.v", Imf::FLOAT, &part.map.values[0].v);
        Imf::MultiPartOutputFile file(memory, &header, 1, false, 0);
        if (!tiled) {
            Imf::OutputPart out(file, 0);
            out.setFrameBuffer(frame);
            out.writePixels(part.map.height);
        }
    }
    return memory.bytes;
}

}  // namespace

TEST_CASE("what it writes, it reads") {
    for (const std::vector<LayerPart>& parts : samples()) {
        const std::vector<LayerPart> read = decode_exr_layers(encode_exr_layers(parts), expected_of(parts));
        REQUIRE(read.size() == parts.size());
        for (std::size_t i = 0; i < parts.size(); ++i) CHECK(equal(read[i], parts[i]));
    }
}

TEST_CASE("OpenEXR reads what it writes") {
    for (const std::vector<LayerPart>& parts : samples()) {
        const Bytes bytes = encode_exr_layers(parts);
        MemoryInput stream("layers", bytes);
        Imf::MultiPartInputFile file(stream, 0, false);
        REQUIRE(file.parts() == static_cast<int>(parts.size()));
        for (int i = 0; i < file.parts(); ++i) {
            const LayerPart& part = parts[static_cast<std::size_t>(i)];
            CHECK(file.header(i).name() == part.name);
            CHECK(file.header(i).compression() == Imf::ZIP_COMPRESSION);
            std::vector<PixelCoord> pixels(part.map.size());
            Imf::FrameBuffer frame;
            const auto add = [&](const char* name, Imf::PixelType type, void* first) {
                frame.insert(name, Imf::Slice(type, static_cast<char*>(first), sizeof(PixelCoord),
                                              sizeof(PixelCoord) * static_cast<std::size_t>(part.map.width)));
            };
            add("face.id", Imf::UINT, &pixels[0].face);
            add("bary.u", Imf::FLOAT, &pixels[0].u);
            add("bary.v", Imf::FLOAT, &pixels[0].v);
            Imf::InputPart in(file, i);
            in.setFrameBuffer(frame);
            in.readPixels(0, part.map.height - 1);
            CHECK(std::equal(pixels.begin(), pixels.end(), part.map.begin()));
        }
    }
}

TEST_CASE("it reads what OpenEXR writes without compression, in ZIPS and in ZIP, and refuses the rest") {
    const LayerPart part = part_of("lod0", 19, 37, WeightPrecision::kFloat, false);
    const ExpectedLayers expected = expected_of({part});
    for (const Imf::Compression compression :
         {Imf::NO_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION})
        CHECK(equal(decode_exr_layers(written_by_openexr(part, compression), expected)[0], part));
    for (const Imf::Compression compression : {Imf::RLE_COMPRESSION, Imf::PIZ_COMPRESSION})
        CHECK_THROWS_AS(decode_exr_layers(written_by_openexr(part, compression), expected), FindingError);
    CHECK_THROWS_AS(decode_exr_layers(written_by_openexr(part, Imf::ZIP_COMPRESSION, true), expected),
                    FindingError);
}

TEST_CASE("no bytes make it crash") {
    std::mt19937 random(1);
    for (int i = 0; i < 6000; ++i) {
        const std::vector<LayerPart>& parts = samples()[random() % samples().size()];
        static const std::vector<Bytes> seeds = {encode_exr_layers(samples()[0]),
                                                 encode_exr_layers(samples()[1]),
                                                 encode_exr_layers(samples()[2])};
        Bytes bytes = seeds[static_cast<std::size_t>(&parts - samples().data())];
        for (unsigned k = 0; k <= random() % 4; ++k) {
            const std::size_t at = random() % bytes.size();
            const std::uint32_t extremes[] = {0, 1, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF};
            if (random() % 3 == 0 && at + 4 <= bytes.size())
                std::memcpy(&bytes[at], &extremes[random() % 5], 4);
            else
                bytes[at] = static_cast<std::uint8_t>(random());
            if (random() % 8 == 0) bytes.resize(1 + bytes.size() - random() % bytes.size() % 64);
        }
        Findings findings = random() % 2 ? Findings::strict() : Findings::collecting();
        try {
            decode_exr_layers(bytes, expected_of(parts), findings);
        } catch (const FindingError& error) {
            CHECK(std::strchr(error.what(), '\n') == nullptr);
        }
    }
}

}  // namespace imgmesh
