// JPEG through libjpeg, in memory.
#include "formats/picture/decode/jpeg_state.h"
#include "formats/picture/decode/picture_decoders.h"
#include "formats/picture/sample_codes.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

// What jpeg_read_header() and the rows are read with.
struct State : JpegState {
    std::span<const std::uint8_t> file;
    std::vector<std::uint8_t> samples;
    std::size_t row = 0;  ///< bytes
};

State& own(JpegState& s) {
    return static_cast<State&>(s);
}

void read_header(JpegState& state) {
    State& s = own(state);
    jpeg_create_decompress(&s.jpeg);
    jpeg_mem_src(&s.jpeg, s.file.data(), static_cast<unsigned long>(s.file.size()));
    jpeg_read_header(&s.jpeg, TRUE);
    s.choose_output();
}

void read_rows(JpegState& state) {
    State& s = own(state);
    jpeg_start_decompress(&s.jpeg);
    while (s.jpeg.output_scanline < s.jpeg.output_height) {
        JSAMPROW row = s.samples.data() + s.row * s.jpeg.output_scanline;
        jpeg_read_scanlines(&s.jpeg, &row, 1);
    }
}

void check_scans(const std::string& path, const JpegMarkers& m) {
    if (m.scans > kMostJpegScans)
        throw Error(ErrorKind::kUnsupported,
                    cat(path, ": JPEG images of more than ", kMostJpegScans, " scans are not supported"));
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

}  // namespace

DecodedPicture decode_jpeg(const PictureFile& file) {
    const std::string& path = file.path;
    JpegMarkers markers = jpeg_markers(file.bytes);
    check_jpeg_frame(path, markers, file.options.limits);
    check_scans(path, markers);
    State s;
    s.file = file.bytes;
    if (!s.guarded(read_header)) throw s.broken(path);
    const auto width = s.jpeg.output_width, height = s.jpeg.output_height;
    const int channels = s.jpeg.out_color_components;
    check_size(path, width, height, channels, file.options.limits);
    s.row = std::size_t{width} * static_cast<std::size_t>(channels);
    s.samples.resize(s.row * height);
    if (!s.guarded(read_rows)) throw s.broken(path);

    DecodedPicture out;
    out.image = make_image(static_cast<int>(width), static_cast<int>(height), channels);
    floats_from_codes(s.samples, out.image.data);
    out.color = stated_color(markers);
    if (s.jpeg.out_color_space == JCS_CMYK) name_inks(out, s.jpeg.saw_Adobe_marker != 0);
    out.orientation = markers.orientation;
    out.warnings = std::move(markers.warnings);
    if (const std::string damage = s.damage(); !damage.empty()) out.warnings.push_back(damage);
    if (!markers.ends) out.warnings.emplace_back("the JPEG ends early, but all of its pixels are there");
    return out;
}

}  // namespace imgmesh
