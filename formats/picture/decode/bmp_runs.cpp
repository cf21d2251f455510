#include "formats/picture/decode/bmp_runs.h"

#include "formats/files/byte_reader.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

// Writes indices from a place that only moves on, so no pixel is written twice.
struct Canvas {
    std::int64_t width, height;
    bool top_down;
    std::vector<std::uint16_t> indices = std::vector<std::uint16_t>(static_cast<std::size_t>(width * height));
    std::int64_t x = 0, y = 0;
    std::int64_t written = 0, dropped = 0;

    void put(std::uint16_t index) {
        if (x < width && y < height) {
            const std::int64_t row = top_down ? y : height - 1 - y;
            indices[static_cast<std::size_t>(row * width + x)] = index;
            ++written;
            ++x;  // beyond a row it stays at its end
        } else {
            ++dropped;
        }
    }
    bool is_complete() const { return y >= height || written == width * height; }
};

// The index of pixel i of a piece: bytes of one or, for runs of 4 bits, two indices.
std::uint16_t index_at(std::span<const std::uint8_t> piece, std::size_t i, bool two) {
    if (!two) return piece[i];
    return i % 2 == 0 ? piece[i / 2] >> 4 : piece[i / 2] & 15;
}

// Returns whether the runs say that they end. Throws EndOfBytes if they stop without that.
bool read_code(ByteReader& in, bool two, Canvas& canvas) {
    const std::uint32_t count = in.number(1);
    if (count > 0) {
        const auto value = in.take(1);
        for (std::uint32_t i = 0; i < count; ++i) canvas.put(index_at(value, two ? i % 2 : 0, two));
        return false;
    }
    const std::uint32_t code = in.number(1);
    if (code == 0) {
        canvas.x = 0;
        ++canvas.y;
    } else if (code == 1) {
        return true;
    } else if (code == 2) {
        canvas.x += in.number(1);
        canvas.y += in.number(1);
    } else {
        const std::size_t size = two ? (code + 1) / 2 : code;
        const auto piece = in.take(size);
        for (std::uint32_t i = 0; i < code; ++i) canvas.put(index_at(piece, i, two));
        if (size % 2 != 0 && in.left() > 0) in.take(1);
    }
    return false;
}

}  // namespace

std::vector<std::uint16_t> read_bmp_runs(const std::string& path, const BmpHeader& header,
                                         std::span<const std::uint8_t> bytes,
                                         std::vector<std::string>& warnings) {
    Canvas canvas{header.width, header.height, header.top_down};
    ByteReader in(bytes, ByteOrder::kLittle);
    try {
        while (canvas.y < canvas.height && !read_code(in, header.coding == BmpCoding::kRuns4, canvas)) {
        }
    } catch (const EndOfBytes&) {
        if (!canvas.is_complete())
            throw Error(ErrorKind::kBadFile, cat(path, ": the BMP is truncated: its runs end after ",
                                                 canvas.written, " of ", canvas.indices.size(), " pixels"));
    }
    const std::int64_t missed = canvas.width * canvas.height - canvas.written;
    if (missed > 0)
        warnings.push_back(
            cat("pixels that its runs step over, which have the palette's first colour: ", missed));
    if (canvas.dropped > 0)
        warnings.push_back(cat("pixels of its runs beyond a row, which were dropped: ", canvas.dropped));
    return std::move(canvas.indices);
}

}  // namespace imgmesh
