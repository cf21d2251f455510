#include "formats/picture/decode/jpeg_state.h"

#include <jerror.h>

#include <new>

namespace imgmesh {
namespace {

JpegState& state_of(j_common_ptr jpeg) {
    return *static_cast<JpegState*>(jpeg->client_data);
}

[[noreturn]] void on_error(j_common_ptr jpeg) {
    JpegState& s = state_of(jpeg);
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
    JpegState& s = state_of(jpeg);
    if (loses_pixels(jpeg->err->msg_code)) on_error(jpeg);
    // The end of the file is known already, and matters only if pixels are missing.
    if (s.warning[0] == 0 && jpeg->err->msg_code != JWRN_JPEG_EOF)
        jpeg->err->format_message(jpeg, s.warning.data());
}

}  // namespace

JpegState::JpegState() {
    jpeg.err = jpeg_std_error(&errors);
    jpeg.client_data = this;
    errors.error_exit = on_error;
    errors.emit_message = on_message;
}

bool JpegState::guarded(void (*step)(JpegState&)) {
    if (setjmp(back)) return false;  // NOLINT(cert-err52-cpp): libjpeg knows no other way
    step(*this);
    return true;
}

void JpegState::choose_output() {
    if (jpeg.jpeg_color_space == JCS_YCCK) jpeg.out_color_space = JCS_CMYK;
    jpeg_calc_output_dimensions(&jpeg);
}

Error JpegState::broken(const std::string& path) const {
    if (error_code == JERR_OUT_OF_MEMORY) throw std::bad_alloc();
    return {ErrorKind::kBadFile, cat(path, ": cannot read the image: ", one_line(error.data()))};
}

std::string JpegState::damage() const {
    if (warning[0] == 0) return "";
    return cat("the JPEG is damaged, but all of its pixels are there: ", one_line(warning.data()));
}

void check_jpeg_frame(const std::string& path, const JpegMarkers& m, const ImageLimits& limits) {
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
}

StatedColor stated_color(const JpegMarkers& markers) {
    StatedColor color;
    color.icc = markers.icc;
    if (markers.adobe_rgb) color.name = "AdobeRGB";
    return color;
}

void name_inks(DecodedPicture& picture, bool upside_down) {
    picture.image.channel_names = {"C", "M", "Y", "K"};
    picture.color.inks = true;
    if (upside_down)
        for (float& x : picture.image.data) x = 1 - x;
}

}  // namespace imgmesh
