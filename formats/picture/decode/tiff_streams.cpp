#include "formats/picture/decode/tiff_streams.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "libcore/base/error.h"

namespace imgmesh {
namespace {

static_assert(std::endian::native == std::endian::little, "floats are put together for these machines");

std::uint16_t compression_of(const TiffFile& file) {
    return file.tag<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE);
}
bool is_deflate(const TiffFile& file) {
    const std::uint16_t compression = compression_of(file);
    return compression == COMPRESSION_DEFLATE || compression == COMPRESSION_ADOBE_DEFLATE;
}
std::uint16_t predictor_of(const TiffFile& file) {
    return is_deflate(file) ? file.defaulted_tag<std::uint16_t>(TIFFTAG_PREDICTOR, PREDICTOR_NONE)
                            : std::uint16_t{PREDICTOR_NONE};
}

// TIFF 6.0, section 14: a sample is stored less the one before it of its channel.
template <typename Number>
void add_up(std::span<std::uint8_t> row, std::size_t step) {
    const std::size_t count = row.size() / sizeof(Number);
    for (std::size_t i = step; i < count; ++i) {
        Number before{}, here{};
        std::memcpy(&before, &row[(i - step) * sizeof(Number)], sizeof(Number));
        std::memcpy(&here, &row[i * sizeof(Number)], sizeof(Number));
        here = static_cast<Number>(here + before);
        std::memcpy(&row[i * sizeof(Number)], &here, sizeof(Number));
    }
}

}  // namespace

bool has_plain_rows(const TiffFile& file) {
    return compression_of(file) == COMPRESSION_NONE &&
           file.defaulted_tag<std::uint16_t>(TIFFTAG_FILLORDER, FILLORDER_MSB2LSB) == FILLORDER_MSB2LSB;
}

bool has_streams(const TiffFile& file, const TiffLayout& layout) {
    if (has_plain_rows(file)) return true;
    if (!is_deflate(file) ||
        file.defaulted_tag<std::uint16_t>(TIFFTAG_FILLORDER, FILLORDER_MSB2LSB) != FILLORDER_MSB2LSB)
        return false;
    const int b = layout.bits;
    switch (predictor_of(file)) {
        case PREDICTOR_NONE:
            return true;
        case PREDICTOR_HORIZONTAL:
            return b == 8 || b == 16 || b == 32 || b == 64;
        case PREDICTOR_FLOATINGPOINT:
            return layout.kind == TiffSamples::kFloat;
        default:
            return false;
    }
}

TiffStreams::TiffStreams(const TiffFile& file, const TiffLayout& layout, std::size_t row_bytes)
    : file_(file), layout_(layout), row_bytes_(row_bytes), predictor_(predictor_of(file)) {
    if (is_deflate(file)) inflater_ = std::make_unique<Inflater>(Inflater::Frame::kZlib);
}

TiffStreams::~TiffStreams() = default;

void TiffStreams::begin(std::int64_t strip) {
    const auto index = static_cast<std::uint32_t>(strip);
    strip_ = strip;
    next_ = strip % layout_.blocks_down() * layout_.block_height;
    at_ = TIFFGetStrileOffset(file_.get(), index);
    left_ = TIFFGetStrileByteCount(file_.get(), index);
    if (!inflater_) return;
    inflater_->restart();
    ended_ = false;
}

void TiffStreams::read(std::int64_t y, int plane, std::span<std::uint8_t> row) {
    const std::int64_t strip = plane * layout_.blocks_down() + y / layout_.block_height;
    const auto broken = [&](std::int64_t where) {
        strip_ = -1;
        return file_.broken(cat("the TIFF is broken or truncated in row ", where, " of strip ", strip));
    };
    if (strip != strip_ || y < next_) begin(strip);
    if (!inflater_) {
        const std::uint64_t skipped = static_cast<std::uint64_t>(y - next_) * row_bytes_;
        if (left_ < skipped + row_bytes_) throw broken(y);
        const std::vector<std::uint8_t> bytes = file_.bytes_at(at_ + skipped, row_bytes_);
        if (bytes.size() < row_bytes_) throw broken(y);
        std::ranges::copy(bytes, row.begin());
        strip_ = -1;  // each row has its own place
    } else {
        for (; next_ <= y; ++next_)
            if (!inflate_row(row)) throw broken(next_);
    }
    if (predictor_ != PREDICTOR_FLOATINGPOINT) swap_bytes(row);
    undo_predictor(row);
}

bool TiffStreams::inflate_row(std::span<std::uint8_t> row) {
    while (!row.empty()) {
        if (inflater_->is_used_up() && !next_bytes()) return false;
        const auto [count, state] = inflater_->unpack(row);
        row = row.subspan(count);
        ended_ = state == Inflater::State::kEnded;
        if (ended_) return row.empty();
        if (state == Inflater::State::kBroken) return false;
    }
    return true;
}

bool TiffStreams::ends_well() {
    if (!inflater_ || ended_) return true;
    // Damage may have made the rows longer, which the checksum tells. Some files hold rows for a full strip
    // where the picture ends.
    constexpr std::size_t kPiece = std::size_t{1} << 16;
    const std::uint64_t most = static_cast<std::uint64_t>(layout_.block_height) * row_bytes_;
    planes_.resize(kPiece);
    for (std::uint64_t more = 0; more <= most;) {
        if (inflater_->is_used_up() && !next_bytes()) return false;
        const auto [count, state] = inflater_->unpack(planes_);
        more += count;
        if (state != Inflater::State::kGoesOn) return state == Inflater::State::kEnded;
    }
    return false;
}

// Returns false at the end of the strip.
bool TiffStreams::next_bytes() {
    constexpr std::uint64_t kPacked = std::uint64_t{1} << 16;
    packed_ = file_.bytes_at(at_, static_cast<std::size_t>(std::min(kPacked, left_)));
    if (packed_.empty()) return false;
    at_ += packed_.size();
    left_ -= packed_.size();
    inflater_->give(packed_);
    return true;
}

void TiffStreams::undo_predictor(std::span<std::uint8_t> row) {
    const std::size_t step = layout_.planar ? 1 : static_cast<std::size_t>(layout_.samples);
    if (predictor_ == PREDICTOR_HORIZONTAL) {
        switch (layout_.bits) {
            case 8:
                return add_up<std::uint8_t>(row, step);
            case 16:
                return add_up<std::uint16_t>(row, step);
            case 32:
                return add_up<std::uint32_t>(row, step);
            default:
                return add_up<std::uint64_t>(row, step);
        }
    }
    if (predictor_ != PREDICTOR_FLOATINGPOINT) return;
    // TIFF Technical Note 3: the first bytes of all samples, the second ones, and so on, from the sign's.
    add_up<std::uint8_t>(row, step);
    planes_.assign(row.begin(), row.end());
    const auto bytes = static_cast<std::size_t>(layout_.bits / 8);
    const std::size_t count = row.size() / bytes;
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t b = 0; b < bytes; ++b) row[i * bytes + b] = planes_[(bytes - 1 - b) * count + i];
}

void TiffStreams::swap_bytes(std::span<std::uint8_t> row) const {
    if (!TIFFIsByteSwapped(file_.get()) || layout_.bits % 8 != 0) return;
    const auto bytes = static_cast<std::size_t>(layout_.bits / 8);
    for (std::size_t i = 0; i + bytes <= row.size(); i += bytes)
        std::reverse(row.begin() + static_cast<std::ptrdiff_t>(i),
                     row.begin() + static_cast<std::ptrdiff_t>(i + bytes));
}

}  // namespace imgmesh
