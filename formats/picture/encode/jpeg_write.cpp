// JPEG through libjpeg itself, as it is read: the codecs' program needs 0.15 s to start. Its errors leave by
// longjmp, so functions that it may leave hold nothing that needs a destructor: everything is in a State.
#include <csetjmp>
#include <cstdio>
// jpeglib.h needs stdio.h before it.
#include <jpeglib.h>

#include <cstdlib>
#include <new>

#include "formats/picture/color/icc_profile.h"
#include "formats/picture/encode/picture_encoders.h"
#include "formats/picture/sample_codes.h"

namespace imgmesh {
namespace {

constexpr int kQuality = 95;

struct State {
    jpeg_compress_struct jpeg = {};
    jpeg_error_mgr errors = {};
    std::jmp_buf back;
    std::vector<std::uint8_t> codes, icc;
    JDIMENSION width = 0, height = 0;
    int channels = 0;
    unsigned char* bytes = nullptr;  ///< malloc's, once all is written
    unsigned long size = 0;

    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() { jpeg_destroy_compress(&jpeg); }
};

[[noreturn]] void on_error(j_common_ptr jpeg) {
    std::longjmp(static_cast<State*>(jpeg->client_data)->back, 1);
}

void write(State& s) {
    jpeg_create_compress(&s.jpeg);
    jpeg_mem_dest(&s.jpeg, &s.bytes, &s.size);
    s.jpeg.image_width = s.width;
    s.jpeg.image_height = s.height;
    s.jpeg.input_components = s.channels;
    s.jpeg.in_color_space = s.channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_set_defaults(&s.jpeg);
    jpeg_set_quality(&s.jpeg, kQuality, TRUE);
    for (int c = 0; c < s.jpeg.num_components; ++c)  // colour is as fine as lightness
        s.jpeg.comp_info[c].h_samp_factor = s.jpeg.comp_info[c].v_samp_factor = 1;
    s.jpeg.optimize_coding = TRUE;
    jpeg_start_compress(&s.jpeg, TRUE);
    if (!s.icc.empty())
        jpeg_write_icc_profile(&s.jpeg, s.icc.data(), static_cast<unsigned int>(s.icc.size()));
    const std::size_t row = std::size_t{s.width} * static_cast<std::size_t>(s.channels);
    while (s.jpeg.next_scanline < s.height) {
        JSAMPROW at = s.codes.data() + row * s.jpeg.next_scanline;
        jpeg_write_scanlines(&s.jpeg, &at, 1);
    }
    jpeg_finish_compress(&s.jpeg);
}

// Returns whether it came to its end.
bool guarded(State& s) {
    if (setjmp(s.back)) return false;  // NOLINT(cert-err52-cpp): libjpeg knows no other way
    write(s);
    return true;
}

}  // namespace

std::vector<std::uint8_t> encode_jpeg(const Image& image) {
    State s;
    s.codes = codes8_from_floats(image.data);
    if (image.color_space != ColorSpace::kSrgb) s.icc = icc_from_color_space(image.color_space);
    s.width = static_cast<JDIMENSION>(image.width);
    s.height = static_cast<JDIMENSION>(image.height);
    s.channels = image.channels;
    s.jpeg.err = jpeg_std_error(&s.errors);
    s.jpeg.client_data = &s;
    s.errors.error_exit = on_error;
    // Sizes and channels are checked, so memory is the only cause left.
    if (!guarded(s)) throw std::bad_alloc();
    std::vector<std::uint8_t> bytes(s.bytes, s.bytes + s.size);
    std::free(s.bytes);
    return bytes;
}

}  // namespace imgmesh
