// PNG through libpng. Its errors leave by longjmp, so functions that it may leave hold nothing that needs a
// destructor: everything is in a State outside of them.
#include <png.h>

#include <bit>
#include <csetjmp>
#include <cstring>
#include <memory>

#include "formats/picture/decode/exif.h"
#include "formats/picture/decode/picture_decoders.h"
#include "formats/picture/sample_codes.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

static_assert(std::endian::native == std::endian::little, "png_set_swap() is for these machines");

struct State {
    std::span<const std::uint8_t> left;  ///< of the file
    std::string error;
    png_structp png = nullptr;
    png_infop info = nullptr;
    png_uint_32 width = 0, height = 0;
    int channels = 0;
    int bits = 0;
    std::vector<std::uint16_t> words;  ///< samples of 16 bits
    std::vector<std::uint8_t> bytes;   ///< or of 8
    std::vector<png_bytep> rows;

    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() { png_destroy_read_struct(&png, &info, nullptr); }
};

void on_error(png_structp png, png_const_charp message) {
    static_cast<State*>(png_get_error_ptr(png))->error = message;
    png_longjmp(png, 1);
}
void on_warning(png_structp, png_const_charp) {}

void on_read(png_structp png, png_bytep out, std::size_t count) {
    auto& left = static_cast<State*>(png_get_io_ptr(png))->left;
    if (count > left.size()) png_error(png, "unexpected end");
    std::memcpy(out, left.data(), count);
    left = left.subspan(count);
}

// Converts palettes to RGB, grey of few bits to 8 bits, and a transparent colour to an alpha channel.
void read_header(State& s) {
    png_read_info(s.png, s.info);
    png_set_expand(s.png);
    png_set_swap(s.png);
    png_set_interlace_handling(s.png);
    png_read_update_info(s.png, s.info);
    s.width = png_get_image_width(s.png, s.info);
    s.height = png_get_image_height(s.png, s.info);
    s.channels = png_get_channels(s.png, s.info);
    s.bits = png_get_bit_depth(s.png, s.info);
}

void read_rows(State& s) {
    png_read_image(s.png, s.rows.data());
    png_read_end(s.png, s.info);  // metadata may follow the pixels
}

// Returns whether `step` came to its end.
bool guarded(State& s, void (*step)(State&)) {
    if (setjmp(png_jmpbuf(s.png))) return false;  // NOLINT(cert-err52-cpp): libpng knows no other way
    step(s);
    return true;
}

void make_rows(State& s) {
    const std::size_t row = std::size_t{s.width} * static_cast<std::size_t>(s.channels);
    s.rows.resize(s.height);
    (s.bits == 16 ? s.words.resize(row * s.height) : s.bytes.resize(row * s.height));
    for (std::size_t y = 0; y < s.height; ++y)
        s.rows[y] =
            s.bits == 16 ? reinterpret_cast<png_bytep>(s.words.data() + y * row) : s.bytes.data() + y * row;
}

StatedColor stated_color(const State& s) {
    StatedColor stated;
    png_charp name = nullptr;
    int method = 0;
    png_bytep profile = nullptr;
    png_uint_32 length = 0;
    if (png_get_iCCP(s.png, s.info, &name, &method, &profile, &length))
        stated.icc.assign(profile, profile + length);
    double encoding = 0;
    int intent = 0;
    if (png_get_sRGB(s.png, s.info, &intent))
        stated.name = "sRGB";
    else if (png_get_gAMA(s.png, s.info, &encoding) && encoding > 0)
        stated.gamma = static_cast<float>(1 / encoding);
    return stated;
}

}  // namespace

DecodedPicture decode_png(const PictureFile& file) {
    const std::string& path = file.path;
    const ImageLimits& limits = file.options.limits;
    check_size(path, file.claim.width, file.claim.height, 1, limits);
    State s;
    const auto broken = [&] {
        return Error(ErrorKind::kBadFile, cat(path, ": cannot read the image: ", one_line(s.error)));
    };
    s.left = file.bytes;
    s.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &s, on_error, on_warning);
    if (s.png) s.info = png_create_info_struct(s.png);
    if (!s.info) throw std::bad_alloc();
    png_set_read_fn(s.png, &s, on_read);
    if (!guarded(s, read_header)) throw broken();
    check_size(path, s.width, s.height, s.channels, limits);
    make_rows(s);
    if (!guarded(s, read_rows)) throw broken();

    DecodedPicture out;
    out.image = make_image(static_cast<int>(s.width), static_cast<int>(s.height), s.channels);
    out.image.sample_type = s.bits == 16 ? SampleType::kUint16 : SampleType::kUint8;
    if (s.bits == 16)
        floats_from_codes(s.words, out.image.data);
    else
        floats_from_codes(s.bytes, out.image.data);
    png_bytep exif = nullptr;
    png_uint_32 length = 0;
    if (png_get_eXIf_1(s.png, s.info, &length, &exif)) out.orientation = exif_orientation({exif, length});
    out.color = stated_color(s);
    return out;
}

}  // namespace imgmesh
