// JPEG by rows, from a file that is not held.
#include "formats/picture/decode/jpeg_state.h"
// It needs jpeglib.h before it.
#include <jerror.h>

#include <algorithm>
#include <utility>

#include "formats/files/random_file.h"
#include "formats/picture/regions/decoded_regions.h"
#include "formats/picture/regions/row_source.h"

namespace imgmesh {
namespace {

constexpr std::size_t kAtOnce = std::size_t{1} << 16;  // bytes of the file

struct Stream : JpegState {
    jpeg_source_mgr source = {};
    jpeg_progress_mgr progress = {};
    const RandomFile* file = nullptr;
    std::uint64_t at = 0;  ///< of the file, behind what libjpeg has
    std::vector<std::uint8_t> bytes = std::vector<std::uint8_t>(kAtOnce);
    bool ended = false;      ///< the file has
    std::string read_error;  ///< of the system
    std::uint8_t* row = nullptr;
};

Stream& own(JpegState& s) {
    return static_cast<Stream&>(s);
}
Stream& own(j_decompress_ptr jpeg) {
    return own(*static_cast<JpegState*>(jpeg->client_data));
}

void init_source(j_decompress_ptr) {}
void term_source(j_decompress_ptr) {}

// At the end of the file libjpeg gets an end of the image, as from its own sources.
boolean fill(j_decompress_ptr jpeg) {
    Stream& s = own(jpeg);
    std::size_t got = 0;
    try {
        got = s.file->read_at(s.at, s.bytes);
    } catch (const Error& error) {  // no exception goes through libjpeg
        s.read_error = error.what();
    }
    s.at += got;
    if (got == 0) {
        s.ended = true;
        WARNMS(jpeg, JWRN_JPEG_EOF);
        s.bytes[0] = 0xFF;
        s.bytes[1] = JPEG_EOI;
        got = 2;
    }
    jpeg->src->next_input_byte = s.bytes.data();
    jpeg->src->bytes_in_buffer = got;
    return TRUE;
}

void skip(j_decompress_ptr jpeg, long count) {
    Stream& s = own(jpeg);
    const std::size_t left = jpeg->src->bytes_in_buffer,
                      wanted = static_cast<std::size_t>(std::max(count, 0L));
    const std::size_t here = std::min(left, wanted);
    jpeg->src->next_input_byte += here;
    jpeg->src->bytes_in_buffer -= here;
    if (!s.ended) s.at += wanted - here;
}

void check_scan(j_common_ptr jpeg) {
    if (reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number > kMostJpegScans)
        ERREXIT1(jpeg, JERR_BAD_PROGRESSION, kMostJpegScans);
}

void read_header(JpegState& state) {
    Stream& s = own(state);
    jpeg_create_decompress(&s.jpeg);
    s.source.init_source = init_source;
    s.source.fill_input_buffer = fill;
    s.source.skip_input_data = skip;
    s.source.resync_to_restart = jpeg_resync_to_restart;
    s.source.term_source = term_source;
    s.jpeg.src = &s.source;
    s.progress.progress_monitor = check_scan;
    s.jpeg.progress = &s.progress;
    jpeg_read_header(&s.jpeg, TRUE);
    s.choose_output();
}

void start(JpegState& s) {
    jpeg_start_decompress(&s.jpeg);
}

void read_row(JpegState& state) {
    Stream& s = own(state);
    JSAMPROW row = s.row;
    jpeg_read_scanlines(&s.jpeg, &row, 1);
}

// Markers up to the pixels: nearly all files have them in the first bytes, and none needs more than this.
JpegMarkers markers_of(const RandomFile& file) {
    constexpr std::size_t kUsual = std::size_t{1} << 20, kMost = std::size_t{64} << 20;
    JpegMarkers markers = jpeg_markers(file.bytes_at(0, kUsual));
    if (markers.scans == 0 && file.size() > kUsual) markers = jpeg_markers(file.bytes_at(0, kMost));
    return markers;
}

class JpegRowSource : public RowSource {
  public:
    JpegRowSource(const std::string& path, const ReadImageOptions& options) : file_(path) {
        const JpegMarkers markers = markers_of(file_);
        const ImageLimits limits = source_limits(options, file_.size());
        check_jpeg_frame(path, markers, limits);
        if (markers.scans == 0)
            throw Error(ErrorKind::kBadFile, cat(path, ": cannot read the image: the JPEG has no pixels"));
        s_.file = &file_;
        if (!s_.guarded(read_header)) throw broken();
        check_size(path, s_.jpeg.output_width, s_.jpeg.output_height, s_.jpeg.out_color_components, limits);
        all_scans_ = markers.is_progressive() || s_.jpeg.comps_in_scan < s_.jpeg.num_components;
        layout_.width = static_cast<int>(s_.jpeg.output_width);
        layout_.height = static_cast<int>(s_.jpeg.output_height);
        layout_.channels = s_.jpeg.out_color_components;
        layout_.orientation = markers.orientation;
        layout_.color = stated_color(markers);
        layout_.color.inks = s_.jpeg.out_color_space == JCS_CMYK;
        layout_.inks_upside_down = layout_.color.inks && s_.jpeg.saw_Adobe_marker;
        layout_.warnings = markers.warnings;
        max_memory_ = options.limits.max_memory;
    }

    const RowLayout& layout() const override { return layout_; }

    void read(std::span<std::uint8_t> row) override {
        if (!started_) begin();
        s_.row = row.data();
        if (!s_.guarded(read_row)) throw broken();
        ++rows_;
        if (s_.ended && rows_ < layout_.height) throw truncated();
    }

    std::vector<std::string> finish() override {
        std::vector<std::string> warnings;
        if (const std::string damage = s_.damage(); !damage.empty()) warnings.push_back(damage);
        if (s_.ended) warnings.emplace_back("the JPEG ends early, but all of its pixels are there");
        return warnings;
    }

  private:
    Error broken() const {
        if (!s_.read_error.empty()) return {ErrorKind::kIo, s_.read_error};
        return s_.broken(file_.path());
    }
    Error truncated() const {
        return {ErrorKind::kBadFile, cat(file_.path(), ": cannot read the image: the JPEG is truncated")};
    }

    // Scans of parts of the image come together as coefficients of all of it.
    void begin() {
        started_ = true;
        if (all_scans_) {
            std::uint64_t samples = 0;
            for (int c = 0; c < s_.jpeg.num_components; ++c) {
                const jpeg_component_info& part = s_.jpeg.comp_info[c];
                samples += std::uint64_t{part.width_in_blocks} * part.height_in_blocks * DCTSIZE2;
            }
            const std::uint64_t bytes = samples * sizeof(JCOEF);
            if (bytes > max_memory_)
                throw Error(ErrorKind::kBadFile,
                            cat(file_.path(), ": the JPEG is progressive, for which ", bytes,
                                " bytes of memory are needed, at most ", max_memory_, " may be taken"));
        }
        if (!s_.guarded(start)) throw broken();
        if (all_scans_ && s_.ended) throw truncated();
    }

    RandomFile file_;
    Stream s_;
    RowLayout layout_;
    std::uint64_t max_memory_ = 0;
    bool all_scans_ = false, started_ = false;
    int rows_ = 0;
};

}  // namespace

std::unique_ptr<RowSource> open_jpeg_rows(const std::string& path, const ReadImageOptions& options) {
    return std::make_unique<JpegRowSource>(path, options);
}

}  // namespace imgmesh
