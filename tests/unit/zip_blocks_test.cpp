// EXR blocks packed by us, read by OpenEXR, and the other way round.
#include "formats/exr/zip_blocks.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <doctest/doctest.h>

#include <numeric>
#include <random>

#include "formats/exr/exr_layers.h"
#include "formats/files/atomic_file.h"
#include "libcore/base/parallel.h"
#include "tests/support/random_mesh_image.h"
#include "tests/support/temporary_folder.h"

using namespace imgmesh;
using Bytes = std::vector<std::uint8_t>;

TEST_CASE("zip blocks: unpack(pack(x)) == x for every length and kind of bytes") {
    std::mt19937 random(1);
    ZipPacker packer;
    ZipUnpacker unpacker;
    for (std::size_t size = 0; size < 200; ++size)
        for (const unsigned levels : {1u, 2u, 256u}) {
            INFO(size << " bytes of " << levels << " values");
            Bytes bytes(size);
            for (auto& b : bytes) b = static_cast<std::uint8_t>(random() % levels);
            const Bytes packed = packer.pack(bytes);
            CHECK(packed.size() <= size);
            CHECK(packer.pack(bytes) == packed);
            Bytes back(size, 77);
            CHECK(unpacker.unpack(packed, back));
            CHECK(back == bytes);
        }
    CHECK(packer.pack(Bytes(4096, 9)).size() < 60);
}

// By hand: 10 20 30 40 50 sorts to 10 30 50 20 40; differences plus 128 are 10 148 148 98 148. Bytes that
// others have deflated without compression ("stored", RFC 1950 and 1951) give the block back.
TEST_CASE("zip blocks: bytes at even places first, then differences") {
    const Bytes stored = {0x78, 0x01, 0x01, 0x05, 0x00, 0xFA, 0xFF, 10,
                          148,  148,  98,   148,  0x05, 0x9B, 0x02, 0x29};
    Bytes block(5);
    REQUIRE(ZipUnpacker().unpack(stored, block));
    CHECK(block == Bytes{10, 20, 30, 40, 50});
}

TEST_CASE("zip blocks: bytes that make another number of samples, or nothing, are refused") {
    std::mt19937 random(2);
    Bytes bytes(300);
    std::iota(bytes.begin(), bytes.end(), std::uint8_t{0});
    const Bytes packed = ZipPacker().pack(bytes);
    REQUIRE(packed.size() < 290);
    ZipUnpacker unpacker;
    for (const std::size_t size : {0u, 1u, 290u, 299u, 301u, 4000u}) {
        Bytes out(size);
        CHECK_FALSE(unpacker.unpack(packed, out));
    }
    for (std::size_t length = 0; length < packed.size(); ++length) {
        Bytes out(300);
        CHECK_FALSE(unpacker.unpack(std::span(packed).first(length), out));
    }
    CHECK_FALSE(unpacker.unpack(Bytes(17, 0xAA), bytes));
}

namespace {

constexpr int kWidth = 21, kHeight = 53;  // blocks of 16 rows and one of five
constexpr std::size_t kFaces = 1000;

LayerPart random_part(const char* name, WeightPrecision precision) {
    std::mt19937 random(5);
    return {name, random_map(kWidth, kHeight, kFaces, precision, true, random), {}, "hash"};
}

}  // namespace

TEST_CASE("layers: OpenEXR reads the numbers that were written") {
    const TemporaryFolder folder;
    for (const WeightPrecision precision : {WeightPrecision::kHalf, WeightPrecision::kFloat})
        for (const std::size_t count : {1u, 2u}) {
            std::vector<LayerPart> parts = {random_part("lod0", precision), random_part("lod1", precision)};
            parts.resize(count);
            for (int i = 0; i < kWidth * kHeight; ++i) parts[0].visits.push_back(static_cast<Id>(i * i));
            save(folder / "w.exr", encode_exr_layers(parts));
            Imf::MultiPartInputFile file((folder / "w.exr").c_str());
            REQUIRE(file.parts() == static_cast<int>(count));
            for (int p = 0; p < file.parts(); ++p) {
                const LayerPart& part = parts[static_cast<std::size_t>(p)];
                CHECK(file.header(p).name() == part.name);
                CHECK(file.header(p).compression() == Imf::ZIP_COMPRESSION);
                CHECK(file.header(p).typedAttribute<Imf::StringAttribute>("imgmesh:topology").value() ==
                      "hash");
                std::vector<PixelCoord> coords(kWidth * kHeight);
                std::vector<Id> visits(part.visits.size());
                Imf::FrameBuffer frame;
                const auto insert = [&](const char* name, Imf::PixelType type, void* first,
                                        std::size_t stride) {
                    frame.insert(name, Imf::Slice(type, static_cast<char*>(first), stride, stride * kWidth));
                };
                insert("face.id", Imf::UINT, &coords[0].face, sizeof(PixelCoord));
                insert("bary.u", Imf::FLOAT, &coords[0].u, sizeof(PixelCoord));
                insert("bary.v", Imf::FLOAT, &coords[0].v, sizeof(PixelCoord));
                if (!visits.empty()) insert("visit.count", Imf::UINT, visits.data(), sizeof(Id));
                Imf::InputPart in(file, p);
                in.setFrameBuffer(frame);
                in.readPixels(0, kHeight - 1);
                CHECK(coords == part.map.values);
                CHECK(visits == part.visits);
            }
        }
}

TEST_CASE("layers: blocks of OpenEXR's own packing, in either order") {
    const TemporaryFolder folder;
    for (const WeightPrecision precision : {WeightPrecision::kHalf, WeightPrecision::kFloat})
        for (const auto compression : {Imf::NO_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION})
            for (const auto order : {Imf::INCREASING_Y, Imf::DECREASING_Y}) {
                INFO("compression " << int{compression} << ", order " << int{order});
                const LayerPart part = random_part("lod0", precision);
                Imf::Header header(kWidth, kHeight, 1, {0, 0}, 1, order, compression);
                header.setName("lod0");
                header.insert("imgmesh:version", Imf::StringAttribute("1.0"));
                const Imf::PixelType weight = precision == WeightPrecision::kHalf ? Imf::HALF : Imf::FLOAT;
                header.channels().insert("face.id", Imf::Channel(Imf::UINT));
                header.channels().insert("bary.u", Imf::Channel(weight));
                header.channels().insert("bary.v", Imf::Channel(weight));
                std::vector<Id> ids;
                std::vector<float> u, v;
                std::vector<half> hu, hv;
                for (const PixelCoord& c : part.map) {
                    ids.push_back(c.face);
                    u.push_back(c.u);
                    v.push_back(c.v);
                    hu.push_back(half(c.u));
                    hv.push_back(half(c.v));
                }
                const bool is_half = weight == Imf::HALF;
                Imf::FrameBuffer frame;
                frame.insert("face.id", Imf::Slice::Make(Imf::UINT, ids.data(), {0, 0}, kWidth, kHeight));
                frame.insert("bary.u", is_half ? Imf::Slice::Make(weight, hu.data(), {0, 0}, kWidth, kHeight)
                                               : Imf::Slice::Make(weight, u.data(), {0, 0}, kWidth, kHeight));
                frame.insert("bary.v", is_half ? Imf::Slice::Make(weight, hv.data(), {0, 0}, kWidth, kHeight)
                                               : Imf::Slice::Make(weight, v.data(), {0, 0}, kWidth, kHeight));
                {
                    Imf::OutputFile file((folder / "o.exr").c_str(), header);
                    file.setFrameBuffer(frame);
                    file.writePixels(kHeight);
                }
                const Bytes bytes = read_file(folder / "o.exr", 1 << 20);
                const auto read = decode_exr_layers(bytes, {kWidth, kHeight, {"lod0"}, {kFaces}, true});
                CHECK(read[0].map.values == part.map.values);
                CHECK(read[0].map.precision == precision);
            }
}

TEST_CASE("layers: the same bytes for any number of threads") {
    std::vector<LayerPart> parts = {random_part("lod0", WeightPrecision::kHalf)};
    Bytes one;
    {
        const ThreadLimit limit(1);
        one = encode_exr_layers(parts);
    }
    const ThreadLimit limit(3);
    CHECK(encode_exr_layers(parts) == one);
}
