// Source: PNG, third edition, sections 5 and 10; RFC 1950.
#include "formats/picture/regions/png_stream.h"

#include <libdeflate.h>

#include <algorithm>

#include "formats/files/byte_reader.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

constexpr std::size_t kMostBeside = std::size_t{64} << 20;  // of chunks that hold no pixels [bytes]
constexpr std::size_t kPacked = std::size_t{1} << 18;       // bytes of the file at once
constexpr std::string_view kPixels = "IDAT";

std::uint32_t crc_of_name() {
    return libdeflate_crc32(0, kPixels.data(), kPixels.size());
}

}  // namespace

PngHead::PngHead(const RandomFile& file) {
    constexpr std::size_t kSignature = 8, kHead = 8, kChecksum = 4;
    bytes_ = file.bytes_at(0, kSignature);
    std::uint64_t at = kSignature;
    for (bool end = false; !end;) {
        const std::vector<std::uint8_t> head = file.bytes_at(at, kHead);
        const ByteReader in(head, ByteOrder::kBig);
        const std::uint64_t length = in.number_at(0, 4), left = file.size() - std::min(file.size(), at);
        if (head.size() == kHead && in.has_at(4, kPixels)) {
            if (pieces_.empty()) {  // an empty chunk stands for all
                bytes_.insert(bytes_.end(), {0, 0, 0, 0, 'I', 'D', 'A', 'T', 0, 0, 0, 0});
            }
            const std::uint64_t here = std::min(length, left - kHead);
            pieces_.push_back({at + kHead, here, here < length || left - kHead - here < kChecksum});
            end = pieces_.back().cut;
        } else {
            const std::uint64_t size = std::min(left, kHead + length + kChecksum);
            if (size > kMostBeside - std::min(bytes_.size(), kMostBeside))
                throw Error(ErrorKind::kBadFile, cat(file.path(), ": the PNG has chunks of more than ",
                                                     kMostBeside, " bytes beside its pixels"));
            const auto chunk = file.bytes_at(at, static_cast<std::size_t>(size));
            bytes_.insert(bytes_.end(), chunk.begin(), chunk.end());
            end = chunk.size() < kHead + length + kChecksum || in.has_at(4, "IEND");
        }
        at += kHead + length + kChecksum;
    }
    parts_ = png_parts(file.path(), bytes_);
}

PngStream::PngStream(const RandomFile& file, const PngHead& head)
    : file_(file), head_(head), crc_(crc_of_name()) {
    constexpr int kDeflate = 8, kDictionary = 32;
    std::array<std::uint8_t, 2> start{};  // of zlib; it may lie in two pieces
    for (std::uint8_t& byte : start) {
        if (inflater_.is_used_up() && !next_bytes()) throw broken("broken: its pixels are missing");
        byte = inflater_.take();
    }
    if ((start[0] & 15) != kDeflate || (start[1] & kDictionary))
        throw broken("broken: its pixels are packed in an unknown way");
}

Error PngStream::broken(const std::string& what) const {
    return {ErrorKind::kBadFile, cat(file_.path(), ": the PNG is ", what)};
}

// Gives the inflater the next bytes of the file; returns false if there are none.
bool PngStream::next_bytes() {
    const std::vector<PngHead::Piece>& pieces = head_.pieces();
    while (piece_ < pieces.size() && in_piece_ == pieces[piece_].size) {
        constexpr std::size_t kChecksum = 4;
        const std::vector<std::uint8_t> sum = file_.bytes_at(pieces[piece_].at + in_piece_, kChecksum);
        if (pieces[piece_].cut || ByteReader(sum, ByteOrder::kBig).number_at(0, 4) != crc_)
            pieces_checked_ = false;
        ++piece_;
        in_piece_ = 0;
        crc_ = crc_of_name();
    }
    if (piece_ == pieces.size()) return false;
    const PngHead::Piece& piece = pieces[piece_];
    packed_ =
        file_.bytes_at(piece.at + in_piece_,
                       static_cast<std::size_t>(std::min<std::uint64_t>(kPacked, piece.size - in_piece_)));
    if (packed_.empty()) return false;  // the file has become shorter
    crc_ = libdeflate_crc32(crc_, packed_.data(), packed_.size());
    in_piece_ += packed_.size();
    inflater_.give(packed_);
    return true;
}

// Returns how many bytes there were.
std::size_t PngStream::unpack(std::span<std::uint8_t> out) {
    std::size_t done = 0;
    while (done < out.size() && !ended_) {
        if (inflater_.is_used_up() && !next_bytes()) break;
        const auto [count, state] = inflater_.unpack(out.subspan(done));
        done += count;
        ended_ = state == Inflater::State::kEnded;
        if (state == Inflater::State::kBroken)
            throw broken(head_.parts().complete ? "broken: its pixels do not unpack"
                                                : "truncated or broken: its pixels do not unpack");
    }
    adler_ = libdeflate_adler32(adler_, out.data(), done);
    return done;
}

void PngStream::read(std::span<std::uint8_t> out) {
    const std::size_t got = unpack(out);
    if (got < out.size())
        throw broken(cat("truncated: a row has ", got, " bytes of pixels, expected ", out.size()));
}

std::vector<std::string> PngStream::finish() {
    std::vector<std::string> warnings;
    std::array<std::uint8_t, 1> beyond{};
    const bool more = !ended_ && unpack(beyond) > 0;
    std::array<std::uint8_t, 4> stored{};
    std::size_t count = 0;
    while (ended_ && count < stored.size()) {
        if (inflater_.is_used_up() && !next_bytes()) break;
        stored[count++] = inflater_.take();
    }
    while (next_bytes()) continue;  // to the last checksum
    const bool summed = count == stored.size();
    const bool sound = summed && ByteReader(stored, ByteOrder::kBig).number_at(0, 4) == adler_;
    const bool complete = head_.parts().complete;
    if (!sound && !pieces_checked_ && complete) throw broken("broken: the checksum of its pixels is wrong");
    if (summed && !sound)
        warnings.emplace_back("the checksum of its unpacked pixels is wrong");
    else if (!pieces_checked_ && complete)
        warnings.emplace_back(
            "the checksum of its packed pixels is wrong, that of the unpacked ones is right");
    if (more) warnings.emplace_back("it holds more pixels than it says");
    if (!complete) warnings.emplace_back("the PNG ends early, but all of its pixels are there");
    return warnings;
}

}  // namespace imgmesh
