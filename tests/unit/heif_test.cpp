// HEIC and AVIF written by libheif: their depth, alpha and colours.
#include <doctest/doctest.h>
#include <libheif/heif.h>

#include "formats/picture/color/icc_profile.h"
#include "formats/picture/image_io.h"
#include "tests/support/picture_files.h"
#include "tests/support/temporary_folder.h"

using namespace imgmesh;

namespace {

// 32 x 32 pixels of one colour, in codes of that many bits, and what is said of their colours.
void write_heif(const std::string& path, heif_compression_format codec, int bits, bool alpha,
                const std::vector<std::uint8_t>& icc) {
    heif_image* image = nullptr;
    const heif_chroma chroma =
        bits > 8 ? (alpha ? heif_chroma_interleaved_RRGGBBAA_LE : heif_chroma_interleaved_RRGGBB_LE)
                 : (alpha ? heif_chroma_interleaved_RGBA : heif_chroma_interleaved_RGB);
    REQUIRE(heif_image_create(32, 32, heif_colorspace_RGB, chroma, &image).code == heif_error_Ok);
    REQUIRE(heif_image_add_plane(image, heif_channel_interleaved, 32, 32, bits).code == heif_error_Ok);
    int stride = 0;
    std::uint8_t* const rows = heif_image_get_plane(image, heif_channel_interleaved, &stride);
    const int channels = alpha ? 4 : 3, most = (1 << bits) - 1;
    for (int y = 0; y < 32; ++y)
        for (int i = 0; i < 32 * channels; ++i) {
            const int code = most / 2;
            std::uint8_t* const at = rows + y * stride + i * (bits > 8 ? 2 : 1);
            at[0] = static_cast<std::uint8_t>(code & 255);
            if (bits > 8) at[1] = static_cast<std::uint8_t>(code >> 8);
        }
    if (!icc.empty()) heif_image_set_raw_color_profile(image, "prof", icc.data(), icc.size());
    heif_context* const context = heif_context_alloc();
    heif_encoder* encoder = nullptr;
    REQUIRE(heif_context_get_encoder_for_format(context, codec, &encoder).code == heif_error_Ok);
    heif_encoder_set_lossy_quality(encoder, 95);
    heif_image_handle* handle = nullptr;
    REQUIRE(heif_context_encode_image(context, image, encoder, nullptr, &handle).code == heif_error_Ok);
    REQUIRE(heif_context_write_to_file(context, path.c_str()).code == heif_error_Ok);
    heif_image_handle_release(handle);
    heif_encoder_release(encoder);
    heif_context_free(context);
    heif_image_release(image);
}

}  // namespace

TEST_CASE("heif: depth, alpha and profile come through") {
    const TemporaryFolder folder;
    const std::string path = folder / "h.heif";
    for (const heif_compression_format codec : {heif_compression_HEVC, heif_compression_AV1})
        for (const int bits : {8, 10})
            for (const bool alpha : {false, true}) {
                if (bits > 8 && codec == heif_compression_AV1) continue;  // libheif 1.15 cannot write it
                INFO("codec " << codec << ", " << bits << " bits, alpha " << alpha);
                write_heif(path, codec, bits, alpha, icc_from_color_space(ColorSpace::kDisplayP3));
                const Image read = read_image(path);
                CHECK(read.width == 32);
                CHECK(read.channels == (alpha ? 4 : 3));
                CHECK(read.color_space == ColorSpace::kDisplayP3);
                CHECK(read.sample_type == (bits > 8 ? SampleType::kUint16 : SampleType::kUint8));
                for (const float x : read.data) CHECK(std::abs(x - 0.5f) < 0.02f);
            }
}

// A statement in the file's own box is changed to PQ and Rec.2020, whose white of paper is code 0.58.
TEST_CASE("heif: code points of the file are obeyed") {
    const TemporaryFolder folder;
    const std::string path = folder / "h.avif";
    write_heif(path, heif_compression_AV1, 8, false, {});
    std::vector<std::uint8_t> file = load(path);
    const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
    const std::size_t at = text.find("colrnclx");
    REQUIRE(at != std::string_view::npos);
    file[at + 9] = 9;
    file[at + 11] = 16;
    save(path, file);
    const Image read = read_image(path);
    CHECK(read.color_space == ColorSpace::kLinear);
    CHECK(read.sample_type == SampleType::kHalf);
    CHECK(read.data[0] == doctest::Approx(92.2 / 203).epsilon(0.1));  // PQ's 0.5
}
