#include <algorithm>

#include "formats/picture/decode/png_rows.h"
#include "formats/picture/regions/decoded_regions.h"
#include "formats/picture/regions/png_stream.h"
#include "formats/picture/regions/row_source.h"
#include "formats/picture/sample_codes.h"

namespace imgmesh {
namespace {

class PngRowSource : public RowSource {
  public:
    PngRowSource(const std::string& path, const ReadImageOptions& options)
        : file_(path), head_(file_), rows_(head_.parts()) {
        const PngParts& parts = head_.parts();
        check_size(path, parts.width, parts.height, rows_.channels(), source_limits(options, file_.size()));
        if (parts.interlaced)
            throw Error(ErrorKind::kUnsupported,
                        cat(path, ": an interlaced PNG cannot be read by rows, expected one without"));
        layout_.width = static_cast<int>(parts.width);
        layout_.height = static_cast<int>(parts.height);
        layout_.channels = rows_.channels();
        layout_.bits = parts.depth == 16 ? 16 : 8;  // fewer bits are codes of 8 exactly
        layout_.orientation = parts.orientation;
        layout_.color = parts.color;
        layout_.warnings = parts.warnings;
        both_.resize(2 * (1 + rows_.bytes(layout_.width)));
        samples_.resize(static_cast<std::size_t>(layout_.width) * static_cast<std::size_t>(layout_.channels));
    }

    const RowLayout& layout() const override { return layout_; }

    void read(std::span<std::uint8_t> row) override {
        if (!stream_) stream_ = std::make_unique<PngStream>(file_, head_);
        // The row above, which has no filter any more, and the new one.
        const std::size_t step = both_.size() / 2;
        std::copy_n(both_.begin() + static_cast<std::ptrdiff_t>(step), step, both_.begin());
        both_[0] = 0;
        stream_->read(std::span(both_).subspan(step));
        if (!rows_.undo_filters(both_.data(), layout_.width, 2))
            throw Error(ErrorKind::kBadFile,
                        cat(file_.path(), ": the PNG is broken: a row has an unknown filter"));
        rows_.expand(both_.data() + step + 1, layout_.width, samples_.data());
        if (layout_.bits == 16) {
            const std::vector<std::uint16_t> codes = codes16_from_floats(samples_);
            const auto* bytes = reinterpret_cast<const std::uint8_t*>(codes.data());
            std::copy_n(bytes, row.size(), row.begin());
        } else {
            std::ranges::copy(codes8_from_floats(samples_), row.begin());
        }
    }

    std::vector<std::string> finish() override {
        return stream_ ? stream_->finish() : std::vector<std::string>();
    }

  private:
    RandomFile file_;
    PngHead head_;
    PngRows rows_;
    RowLayout layout_;
    std::unique_ptr<PngStream> stream_;  ///< from the first row on
    std::vector<std::uint8_t> both_;
    std::vector<float> samples_;
};

}  // namespace

std::unique_ptr<RowSource> open_png_rows(const std::string& path, const ReadImageOptions& options) {
    return std::make_unique<PngRowSource>(path, options);
}

}  // namespace imgmesh
