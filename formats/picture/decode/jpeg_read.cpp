// JPEG through libjpeg. Its errors leave by longjmp, so functions that it may leave hold nothing that needs a
// destructor: everything is in a State outside of them.
#include <csetjmp>
#include <cstdio>
// jpeglib.h needs stdio.h, and jerror.h needs jpeglib.h before it.
#include <jpeglib.h>

#include <jerror.h>

#include <algorithm>
#include <array>
#include <new>

#include "formats/picture/decode/jpeg_markers.h"
#include "formats/picture/decode/picture_decoders.h"
#include "formats/picture/sample_codes.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

struct State {
    jpeg_decompress_struct jpeg = {};
    jpeg_error_mgr errors = {};
    std::jmp_buf back;
    std::span<const std::uint8_t> file;
    std::array<char, JMSG_LENGTH_MAX> error = {};
    int error_code = 0;
    std::array<char, JMSG_LENGTH_MAX> warning = {};  ///< the first
    std::vector<std::uint8_t> samples;
    std::size_t row = 0;  ///< bytes

    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() { jpeg_destroy_decompress(&jpeg); }
};

State& state_of(j_common_ptr jpeg) {
    return *static_cast<State*>(jpeg->client_data);
}

[[noreturn]] void on_error(j_common_ptr jpeg) {
    State& s = state_of(jpeg);
    s.error_code = jpeg->err->msg_code;
    jpeg->err->format_message(jpeg, s.error.data());
    std::longjmp(s.back, 1);
}

// Some warnings say that pixels are lost and were made up. That is an error.
bool loses_pixels(int code) {
    return code == JWRN_HIT_MARKER || code == JWRN_HUFF_BAD_CODE || code == JWRN_ARITH_BAD_CODE ||
           code == JWRN_MUST_RESYNC;
}

void on_message(j_common_ptr jpeg, int level) {
    if (level >= 0) return;  // a trace
    State& s = state_of(jpeg);
    if (loses_pixels(jpeg->err->msg_code)) on_error(jpeg);
    // The end of the file is known already, and matters only if pixels are missing.
    if (s.warning[0] == 0 && jpeg->err->msg_code != JWRN_JPEG_EOF)
        jpeg->err->format_message(jpeg, s.warning.data());
}

void read_header(State& s) {
    jpeg_create_decompress(&s.jpeg);
    jpeg_mem_src(&s.jpeg, s.file.data(), static_cast<unsigned long>(s.file.size()));
    jpeg_read_header(&s.jpeg, TRUE);
    if (s.jpeg.jpeg_color_space == JCS_YCCK) s.jpeg.out_color_space = JCS_CMYK;
    jpeg_calc_output_dimensions(&s.jpeg);
}

void read_rows(State& s) {
    jpeg_start_decompress(&s.jpeg);
    while (s.jpeg.output_scanline < s.jpeg.output_height) {
        JSAMPROW row = s.samples.data() + s.row * s.jpeg.output_scanline;
        jpeg_read_scanlines(&s.jpeg, &row, 1);
    }
}

// Returns whether `step` came to its end.
bool guarded(State& s, void (*step)(State&)) {
    if (setjmp(s.back)) return false;  // NOLINT(cert-err52-cpp): libjpeg knows no other way
    step(s);
    return true;
}

void check_markers(const std::string& path, const JpegMarkers& m, const ImageLimits& limits) {
    if (m.frame == 0) throw Error(ErrorKind::kBadFile, cat(path, ": the JPEG has no image"));
    check_size(path, m.width, m.height, m.channels, limits);
    const auto unsupported = [&](const std::string& what) {
        return Error(ErrorKind::kUnsupported, cat(path, ": ", what, " are not supported"));
    };
    if (m.precision != 8) throw unsupported(cat("JPEG images of ", m.precision, " bits a sample"));
    if (m.frame != 0xC0 && m.frame != 0xC1 && m.frame != 0xC2 && m.frame != 0xC9 && m.frame != 0xCA)
        throw unsupported(m.frame == 0xC3 ? "lossless JPEG images" : "hierarchical JPEG images");
    if (m.channels != 1 && m.channels != 3 && m.channels != 4)
        throw unsupported(cat("JPEG images of ", m.channels, " channels"));
    // Each takes time for all pixels, however few bytes it has. Writers make about ten.
    constexpr int kMostScans = 100;
    if (m.scans > kMostScans) throw unsupported(cat("JPEG images of more than ", kMostScans, " scans"));
    const std::string truncated = cat(path, ": cannot read the image: the JPEG is truncated: ");
    // Two bits a block are the least of Huffman's code. Of the channels other than the first, none may be
    // stored for many pixels.
    const std::size_t blocks = static_cast<std::size_t>(m.width / 8) * static_cast<std::size_t>(m.height / 8);
    if (m.scans == 0 || (!m.is_arithmetic() && !m.is_progressive() && m.packed < blocks / 4))
        throw Error(ErrorKind::kBadFile, cat(truncated, m.packed, " bytes cannot hold its pixels"));
    // A writer may leave out what it likes, but not the end of the file. Arithmetic code has no end of its
    // own.
    if (!m.ends && (!m.whole || m.is_arithmetic()))
        throw Error(ErrorKind::kBadFile, truncated + "a part of its pixels is missing");
}

// Adobe's writers, and all who follow them, store ink upside down.
void finish_ink(const State& s, DecodedPicture& out) {
    out.image.channel_names = {"C", "M", "Y", "K"};
    out.color.inks = true;
    if (s.jpeg.saw_Adobe_marker)
        for (float& x : out.image.data) x = 1 - x;
}

}  // namespace

DecodedPicture decode_jpeg(const PictureFile& file) {
    const std::string& path = file.path;
    JpegMarkers markers = jpeg_markers(file.bytes);
    check_markers(path, markers, file.options.limits);
    State s;
    s.file = file.bytes;
    s.jpeg.err = jpeg_std_error(&s.errors);
    s.jpeg.client_data = &s;
    s.errors.error_exit = on_error;
    s.errors.emit_message = on_message;
    const auto broken = [&] {
        if (s.error_code == JERR_OUT_OF_MEMORY) throw std::bad_alloc();
        return Error(ErrorKind::kBadFile, cat(path, ": cannot read the image: ", one_line(s.error.data())));
    };
    if (!guarded(s, read_header)) throw broken();
    const auto width = s.jpeg.output_width, height = s.jpeg.output_height;
    const int channels = s.jpeg.out_color_components;
    check_size(path, width, height, channels, file.options.limits);
    s.row = std::size_t{width} * static_cast<std::size_t>(channels);
    s.samples.resize(s.row * height);
    if (!guarded(s, read_rows)) throw broken();

    DecodedPicture out;
    out.image = make_image(static_cast<int>(width), static_cast<int>(height), channels);
    floats_from_codes(s.samples, out.image.data);
    if (s.jpeg.out_color_space == JCS_CMYK) finish_ink(s, out);
    out.color.icc = std::move(markers.icc);
    if (markers.adobe_rgb) out.color.name = "AdobeRGB";
    out.orientation = markers.orientation;
    out.warnings = std::move(markers.warnings);
    if (s.warning[0] != 0)
        out.warnings.push_back(
            cat("the JPEG is damaged, but all of its pixels are there: ", one_line(s.warning.data())));
    if (!markers.ends) out.warnings.emplace_back("the JPEG ends early, but all of its pixels are there");
    return out;
}

}  // namespace imgmesh
