#include "formats/export/label_files.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenImageIO/imageio.h>
#include <doctest/doctest.h>
#include <libdeflate.h>

#include <limits>

#include "formats/export/contour_files.h"
#include "formats/files/atomic_file.h"
#include "tests/support/picture_files.h"
#include "tests/support/temporary_folder.h"

using namespace imgmesh;

namespace {

template <typename Value>
std::vector<Value> read_exr_layer(const std::string& path, const char* channel, Imf::PixelType type) {
    Imf::InputFile file(path.c_str());
    const Imath::Box2i window = file.header().dataWindow();
    const int width = window.max.x + 1, height = window.max.y + 1;
    REQUIRE(file.header().channels().findChannel(channel));
    REQUIRE(file.header().channels().findChannel(channel)->type == type);
    std::vector<Value> values(static_cast<std::size_t>(width * height));
    Imf::FrameBuffer buffer;
    buffer.insert(channel, Imf::Slice::Make(type, values.data(), {0, 0}, width, height));
    file.setFrameBuffer(buffer);
    file.readPixels(0, height - 1);
    return values;
}

std::vector<std::uint16_t> read_png(const std::string& path) {
    const auto in = OIIO::ImageInput::open(path);
    REQUIRE(in);
    CHECK(in->spec().format == OIIO::TypeUInt16);
    REQUIRE(in->spec().nchannels == 1);
    std::vector<std::uint16_t> values(in->spec().image_pixels());
    REQUIRE(in->read_image(0, 0, 0, 1, OIIO::TypeUInt16, values.data()));
    return values;
}

}  // namespace

TEST_CASE("labels: every number comes back, and none is the largest number of the file") {
    const TemporaryFolder folder;
    const std::vector<Id> labels = {0, 1, 65534, kNone, 40000, 255};
    write_labels(folder / "a.exr", 3, 2, labels, true);
    CHECK(read_exr_layer<Id>(folder / "a.exr", "id", Imf::UINT) == labels);
    write_labels(folder / "a.PNG", 3, 2, labels, true);
    CHECK(read_png(folder / "a.PNG") == std::vector<std::uint16_t>{0, 1, 65534, 65535, 40000, 255});
    std::vector<Id> all(65535);
    for (Id i = 0; i < all.size(); ++i) all[i] = i;
    write_labels(folder / "all.png", 257, 255, all, true);
    const std::vector<std::uint16_t> back = read_png(folder / "all.png");
    CHECK(std::equal(all.begin(), all.end(), back.begin(), back.end()));
}

// OpenImageIO's reader is libtiff, which checks the file's structure.
TEST_CASE("labels: a TIFF holds all 32 bits, in several strips too") {
    const TemporaryFolder folder;
    constexpr int kWidth = 301, kHeight = 257;
    std::vector<Id> labels(kWidth * kHeight);
    for (Id i = 0; i < labels.size(); ++i) labels[i] = i * 2654435761u;
    labels.back() = kNone;
    write_labels(folder / "a.tif", kWidth, kHeight, labels, true);
    const auto in = OIIO::ImageInput::open(folder / "a.tif");
    REQUIRE(in);
    CHECK(in->spec().format == OIIO::TypeUInt32);
    CHECK(in->spec().width == kWidth);
    CHECK(in->spec().height == kHeight);
    REQUIRE(in->spec().nchannels == 1);
    std::vector<Id> back(labels.size());
    REQUIRE(in->read_image(0, 0, 0, 1, OIIO::TypeUInt32, back.data()));
    CHECK(back == labels);
}

TEST_CASE("labels: what a PNG cannot hold is refused, and nothing is left behind") {
    const TemporaryFolder folder;
    const std::vector<Id> labels = {0, 65535, kNone};
    std::string text;
    CHECK(error_of([&] { write_labels(folder / "a.png", 3, 1, labels, true); }, &text) ==
          ErrorKind::kBadArgument);
    CHECK(text.find("65535") != std::string::npos);
    CHECK(error_of([&] { write_labels(folder / "a.jpg", 3, 1, labels, true); }) == ErrorKind::kBadArgument);
    CHECK(error_of([&] { write_contours(folder / "a.png", 1, 1, std::vector<float>{1}, 5, true); }) ==
          ErrorKind::kBadArgument);
    CHECK(folder.count() == 0);
    write_labels(folder / "a.exr", 3, 1, labels, true);
    CHECK(read_exr_layer<Id>(folder / "a.exr", "id", Imf::UINT) == labels);
    CHECK(error_of([&] { write_labels(folder / "a.exr", 3, 1, labels, false); }) == ErrorKind::kIo);
    CHECK(error_of([&] { write_labels(folder / "no/a.exr", 3, 1, labels, true); }) == ErrorKind::kIo);
}

TEST_CASE("float layers keep every bit, infinity too") {
    const TemporaryFolder folder;
    const std::vector<float> values = {0, 1.0f / 3, 1e-30f, std::numeric_limits<float>::infinity()};
    write_float_layer(folder / "a.exr", "height", 1, 4, values, true);
    CHECK(read_exr_layer<float>(folder / "a.exr", "height", Imf::FLOAT) == values);
    CHECK(folder.count() == 1);
}

// Variables have an upper bound on their size, not on their number of labels: 65536 of them take 32 bits.
TEST_CASE("labels: a .mat has 16 bits a label if these hold all of them") {
    const TemporaryFolder folder;
    std::vector<Id> labels(200 * 400);
    for (Id i = 0; i < labels.size(); ++i) labels[i] = i % 65535;
    write_labels(folder / "small.mat", 400, 200, labels, true);
    labels[0] = 65535;
    write_labels(folder / "large.mat", 400, 200, labels, true);
    const auto element = [](const std::string& path) {  // without what compresses it
        const std::vector<std::uint8_t> bytes = read_file(path, 1 << 20);
        std::vector<std::uint8_t> out(1 << 20);
        std::size_t size = 0;
        libdeflate_decompressor* const unpacker = libdeflate_alloc_decompressor();
        REQUIRE(libdeflate_zlib_decompress(unpacker, bytes.data() + 136, bytes.size() - 136, out.data(),
                                           out.size(), &size) == LIBDEFLATE_SUCCESS);
        libdeflate_free_decompressor(unpacker);
        out.resize(size);
        return out;
    };
    // Tag, flags, sides and name of the cell array take 48 bytes; so do those of the matrix, with no name.
    const std::vector<std::uint8_t> small = element(folder / "small.mat"),
                                    large = element(folder / "large.mat");
    CHECK(small.size() == 48 + 48 + 8 + 2 * labels.size());
    CHECK(large.size() == 48 + 48 + 8 + 4 * labels.size());
    CHECK(int(small[64]) == 11);
    CHECK(int(large[64]) == 13);
}
