#include "formats/exr/exr_layers.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfPreviewImage.h>
#include <ImfStringAttribute.h>
#include <ImfStringVectorAttribute.h>
#include <ImfTiledOutputFile.h>
#include <doctest/doctest.h>

#include "formats/files/atomic_file.h"
#include "formats/findings/finding_error.h"
#include "libcore/base/error.h"
#include "tests/support/random_mesh_image.h"
#include "tests/support/temporary_folder.h"

using namespace imgmesh;

namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr int kWidth = 9, kHeight = 37;  // more rows than a ZIP block has
constexpr std::size_t kFaces = 100;

std::vector<LayerPart> random_parts(WeightPrecision precision, bool mask) {
    std::mt19937 random(5);
    std::vector<LayerPart> parts;
    for (const char* name : {"lod0", "lod1", "lod2"})
        parts.push_back(
            {name, random_map(kWidth, kHeight, kFaces, precision, mask, random), {}, cat("hash of ", name)});
    for (int i = 0; i < kWidth * kHeight; ++i) parts[0].visits.push_back(static_cast<Id>(random()));
    return parts;
}

ExpectedLayers expect(const std::vector<LayerPart>& parts) {
    ExpectedLayers expected{kWidth, kHeight, {}, std::vector<std::uint64_t>(parts.size(), kFaces), true};
    for (const LayerPart& part : parts) expected.parts.push_back(part.name);
    return expected;
}

std::string finding(const Bytes& bytes, const ExpectedLayers& expected) {
    try {
        decode_exr_layers(bytes, expected);
    } catch (const FindingError& error) {
        return std::string(error.code());
    }
    return "";
}

// Files as other software could write them.
struct Foreign {
    Imf::Header header{kWidth, kHeight};
    std::string version = "1.3";
    std::vector<std::uint32_t> face = std::vector<std::uint32_t>(kWidth * kHeight, 7);
    std::vector<float> u = std::vector<float>(kWidth * kHeight, 0.1f);
    std::vector<float> v = std::vector<float>(kWidth * kHeight, 0.7f);

    Foreign() {
        header.setName("lod0");
        header.compression() = Imf::ZIPS_COMPRESSION;
        header.channels().insert("face.id", Imf::Channel(Imf::UINT));
        header.channels().insert("bary.u", Imf::Channel(Imf::FLOAT));
        header.channels().insert("bary.v", Imf::Channel(Imf::FLOAT));
    }
    Bytes write(bool tiled = false) {
        if (!version.empty()) header.insert("imgmesh:version", Imf::StringAttribute(version));
        const TemporaryFolder folder;
        Imf::FrameBuffer frame;
        const auto insert = [&](const char* name, Imf::PixelType type, void* data) {
            if (header.channels().findChannel(name))
                frame.insert(name, Imf::Slice(type, static_cast<char*>(data), 4, 4 * kWidth));
        };
        insert("face.id", Imf::UINT, face.data());
        insert("bary.u", Imf::FLOAT, u.data());
        insert("bary.v", Imf::FLOAT, v.data());
        insert("G", Imf::FLOAT, v.data());
        if (tiled) {
            Imf::TiledOutputFile file((folder / "x.exr").c_str(), header);
            file.setFrameBuffer(frame);
            file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
        } else {
            Imf::OutputFile file((folder / "x.exr").c_str(), header);
            file.setFrameBuffer(frame);
            file.writePixels(header.dataWindow().max.y - header.dataWindow().min.y + 1);
        }
        return read_file(folder / "x.exr", 1 << 20);
    }
    ExpectedLayers expected{kWidth, kHeight, {"lod0"}, {kFaces}, false};
};

}  // namespace

TEST_CASE("layers: decode(encode(x)) == x, and the same bytes each time") {
    for (const WeightPrecision precision : {WeightPrecision::kHalf, WeightPrecision::kFloat})
        for (const std::size_t count : {1u, 3u}) {
            std::vector<LayerPart> parts = random_parts(precision, true);
            parts.resize(count);
            const Bytes bytes = encode_exr_layers(parts);
            CHECK(bytes == encode_exr_layers(parts));
            const std::vector<LayerPart> back = decode_exr_layers(bytes, expect(parts));
            REQUIRE(back.size() == count);
            for (std::size_t i = 0; i < count; ++i) {
                CHECK(back[i].name == parts[i].name);
                CHECK(back[i].map.values == parts[i].map.values);
                CHECK(back[i].map.precision == precision);
                CHECK(back[i].visits == parts[i].visits);
                CHECK(back[i].topology == parts[i].topology);
            }
        }
}

TEST_CASE("layers: the writer refuses weights that would not survive") {
    for (const PixelCoord bad :
         {PixelCoord{1, 0.3f, 0.1f}, PixelCoord{1, 0.75f, 0.5f}, PixelCoord{1, -0.25f, 0.5f},
          PixelCoord{1, NAN, 0}, PixelCoord{kNone, 0.5f, 0}}) {
        std::vector<LayerPart> parts = random_parts(WeightPrecision::kHalf, true);
        parts[1].map[20] = bad;
        CHECK_THROWS_AS(encode_exr_layers(parts), Error);
    }
}

TEST_CASE("layers: what does not fit the container is refused by its code") {
    const std::vector<LayerPart> parts = random_parts(WeightPrecision::kHalf, true);
    const Bytes bytes = encode_exr_layers(parts);
    const auto with = [&](const auto& change) {
        ExpectedLayers expected = expect(parts);
        change(expected);
        return finding(bytes, expected);
    };
    CHECK(with([](ExpectedLayers&) {}) == "");
    CHECK(with([](ExpectedLayers& e) { e.width = 8; }) == "layers.window");
    CHECK(with([](ExpectedLayers& e) { e.width = e.height = 100000; }) == "layers.size");
    CHECK(with([](ExpectedLayers& e) { e.parts[1] = "lod7"; }) == "layers.parts");
    CHECK(with([](ExpectedLayers& e) {
              e.parts.push_back("lod3");
              e.faces.push_back(1);
          }) == "layers.parts");
    CHECK(with([](ExpectedLayers& e) { e.parts.pop_back(); }) == "layers.parts");
    CHECK(with([](ExpectedLayers& e) { e.faces[2] = kFaces - 5; }) == "layers.face_range");
    CHECK(with([](ExpectedLayers& e) { e.has_mask = false; }) == "layers.mask");
}

TEST_CASE("layers: files of other software") {
    // Weights off the grid are rounded down to it, so u + v <= 1 still holds.
    const std::vector<LayerPart> parts = decode_exr_layers(Foreign().write(), Foreign().expected);
    const PixelCoord c = parts[0].map[11];
    CHECK(parts[0].map.precision == WeightPrecision::kFloat);
    CHECK(c.face == 7);
    CHECK(c.u / kFloatWeightStep == std::floor(0.1f / kFloatWeightStep));
    CHECK(c.v == 0.7f);  // on the grid already
    CHECK_NOTHROW(encode_exr_layers(parts));

    const auto with = [](const auto& change) {
        Foreign file;
        change(file);
        return finding(file.write(file.header.hasTileDescription()), file.expected);
    };
    const auto tiles = [](unsigned side, Imf::LevelMode mode) {
        return [=](Foreign& f) { f.header.setTileDescription({side, side, mode}); };
    };
    CHECK(with(tiles(16, Imf::ONE_LEVEL)) == "");
    CHECK(with(tiles(4096, Imf::ONE_LEVEL)) == "layers.tiles");
    CHECK(with(tiles(16, Imf::MIPMAP_LEVELS)) == "layers.tiles");
    CHECK(with([](Foreign& f) { f.header.compression() = Imf::PIZ_COMPRESSION; }) == "layers.compression");
    CHECK(with([](Foreign& f) { f.header.compression() = Imf::DWAA_COMPRESSION; }) == "layers.compression");
    CHECK(with([](Foreign& f) { f.header.channels().insert("G", Imf::Channel(Imf::FLOAT)); }) ==
          "layers.channels");
    CHECK(with([](Foreign& f) {
              f.header.channels() = Imf::ChannelList();
              f.header.channels().insert("face.id", Imf::Channel(Imf::UINT));
          }) == "layers.missing");
    CHECK(with([](Foreign& f) { f.version = "2.0"; }) == "layers.version");
    CHECK(with([](Foreign& f) { f.version = ""; }) == "layers.version");
    CHECK(with([](Foreign& f) { f.header.setName("lod1"); }) == "layers.parts");
    CHECK(with([](Foreign& f) { f.header.displayWindow().max.x += 1; }) == "layers.window");
    CHECK(with([](Foreign& f) { f.header.insert("note", Imf::StringAttribute(std::string(70000, 'x'))); }) ==
          "layers.attribute");
    CHECK(with([](Foreign& f) { f.header.insert("names", Imf::StringVectorAttribute({"x"})); }) ==
          "layers.attribute");
    CHECK(with([](Foreign& f) { f.header.setPreviewImage(Imf::PreviewImage(2, 2)); }) == "layers.attribute");
    CHECK(with([](Foreign& f) { f.face[40] = kFaces; }) == "layers.face_range");
    CHECK(with([](Foreign& f) { f.face[40] = kNone; }) == "layers.mask");
    CHECK(with([](Foreign& f) {
              f.face[40] = kNone;
              f.expected.has_mask = true;
          }) == "layers.mask");  // u != 0
    CHECK(with([](Foreign& f) { f.u[40] = 0.31f; }) == "layers.weights");
    CHECK(with([](Foreign& f) { f.u[40] = -0.01f; }) == "layers.weights");
    CHECK(with([](Foreign& f) { f.u[40] = NAN; }) == "layers.weights");
    CHECK(with([](Foreign& f) { f.u[40] = INFINITY; }) == "layers.weights");
}

TEST_CASE("layers: truncated and flipped bytes give a finding or the right sizes, never a crash") {
    const std::vector<LayerPart> parts = random_parts(WeightPrecision::kHalf, true);
    const Bytes bytes = encode_exr_layers(parts);
    const ExpectedLayers expected = expect(parts);
    for (std::size_t length = 0; length < bytes.size(); length += 1 + length / 100)
        CHECK(finding(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length)), expected) !=
              "");
    std::mt19937 random(6);
    for (int i = 0; i < 3000; ++i) {
        Bytes flipped = bytes;
        const std::size_t at = random() % (i % 2 ? flipped.size() : 1200);
        flipped[at] = static_cast<std::uint8_t>(flipped[at] ^ (1 + random() % 255));
        try {
            for (const LayerPart& part : decode_exr_layers(flipped, expected))
                CHECK(part.map.size() == kWidth * kHeight);
        } catch (const FindingError&) {
        }
    }
}
