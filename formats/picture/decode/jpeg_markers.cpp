// Sources: ITU-T T.81, annex B; ICC.1:2010, annex B.4 (profiles in pieces); EXIF 2.3, 4.7; XMP part 3, 1.1.3.
#include "formats/picture/decode/jpeg_markers.h"

#include <algorithm>
#include <array>
#include <map>

#include "formats/files/byte_reader.h"
#include "formats/picture/decode/exif.h"

namespace imgmesh {
namespace {

using Bytes = std::span<const std::uint8_t>;

class MarkerScan {
  public:
    explicit MarkerScan(Bytes bytes) : bytes_(bytes), in_(bytes, ByteOrder::kBig) {}

    JpegMarkers markers() {
        std::size_t at = 2;  // after SOI
        while (at + 1 < bytes_.size()) {
            if (bytes_[at] != 0xFF || bytes_[at + 1] == 0 || bytes_[at + 1] == 0xFF) {
                ++at;
                continue;
            }
            const std::uint8_t marker = bytes_[at + 1];
            at += 2;
            constexpr std::uint8_t kEnd = 0xD9, kStart = 0xD8, kScan = 0xDA;
            if (marker == kEnd) {
                out_.ends = true;
                break;
            }
            if (marker == 0x01 || (marker >= 0xD0 && marker <= kStart)) continue;  // these have no content
            const std::size_t length = in_.number_at(at, 2);
            if (length < 2 || length > bytes_.size() - at) continue;  // stray bytes, or the end is missing
            use(marker, bytes_.subspan(at + 2, length - 2));
            at += length;
            if (marker == kScan) at = end_of_scan(at);
        }
        join_profile();
        if (out_.orientation == 0) out_.orientation = xmp_orientation_;
        out_.whole = std::ranges::all_of(channels_, [](const auto& channel) {
            return std::ranges::all_of(channel.second, [](int bits) { return bits == 0; });
        });
        return std::move(out_);
    }

  private:
    // Returns the place of the next marker other than RST.
    std::size_t end_of_scan(std::size_t at) {
        const std::size_t start = at;
        while (at + 1 < bytes_.size()) {
            const std::uint8_t next = bytes_[at + 1];
            if (bytes_[at] == 0xFF && next != 0 && next != 0xFF && !(next >= 0xD0 && next <= 0xD7)) break;
            ++at;
        }
        if (at + 1 >= bytes_.size()) at = bytes_.size();
        out_.packed += at - start;
        out_.scans += at > start;
        return at;
    }

    void use(std::uint8_t marker, Bytes b) {
        const ByteReader in(b, ByteOrder::kBig);
        const bool frame =
            marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
        if (frame && out_.frame == 0 && b.size() >= 6) {
            out_.frame = marker;
            out_.precision = b[0];
            out_.height = static_cast<int>(in.number_at(1, 2));
            out_.width = static_cast<int>(in.number_at(3, 2));
            out_.channels = b[5];
            for (std::size_t i = 6; i + 2 < b.size() && i < 6 + 3 * std::size_t{b[5]}; i += 3)
                channels_[b[i]].fill(kMissing);
        } else if (marker == 0xDA && !b.empty()) {
            use_scan(b);
        } else if (marker == 0xE1) {
            use_metadata(b);
        } else if (marker == 0xE2 && text_of(b).starts_with(kProfile) && b.size() >= kProfile.size() + 2) {
            pieces_.try_emplace(b[kProfile.size()], b.subspan(kProfile.size() + 2));
            piece_count_ = b[kProfile.size() + 1];
        }
    }

    void use_scan(Bytes b) {
        const std::size_t count = b[0];
        if (b.size() < 4 + 2 * count) return;
        const bool progressive = out_.is_progressive();
        const std::size_t first = progressive ? b[1 + 2 * count] : 0,
                          last = progressive ? b[2 + 2 * count] : 63;
        const int low = progressive ? b[3 + 2 * count] & 15 : 0;
        for (std::size_t i = 0; i < count; ++i) {
            const auto channel = channels_.find(b[1 + 2 * i]);
            if (channel == channels_.end()) continue;
            for (std::size_t k = first; k <= std::min<std::size_t>(last, 63); ++k) channel->second[k] = low;
        }
    }

    void use_metadata(Bytes b) {
        constexpr std::string_view kExif("Exif\0\0", 6), kXmp("http://ns.adobe.com/xap/1.0/\0", 29);
        if (text_of(b).starts_with(kExif) && !has_exif_) {
            has_exif_ = true;
            const ExifFacts facts = exif_facts(b);
            out_.orientation = facts.orientation;
            out_.adobe_rgb = facts.adobe_rgb;
        } else if (text_of(b).starts_with(kXmp) && xmp_orientation_ == 0) {
            xmp_orientation_ = xmp_orientation(text_of(b.subspan(kXmp.size())));
        }
    }

    void join_profile() {
        if (pieces_.empty()) return;
        std::size_t expected = 1;
        for (const auto& piece : pieces_)
            if (piece.first == expected) ++expected;
        if (expected <= piece_count_) {
            out_.warnings.emplace_back("a piece of its ICC profile is missing, and the profile is not used");
            return;
        }
        for (const auto& piece : pieces_)
            if (piece.first >= 1 && piece.first <= piece_count_)
                out_.icc.insert(out_.icc.end(), piece.second.begin(), piece.second.end());
    }

    static constexpr std::string_view kProfile{"ICC_PROFILE\0", 12};
    static constexpr int kMissing = -1;

    Bytes bytes_;
    ByteReader in_;
    std::map<std::uint8_t, std::array<int, 64>> channels_;  ///< by id: bits that each coefficient lacks
    std::map<std::uint8_t, Bytes> pieces_;
    std::size_t piece_count_ = 0;
    bool has_exif_ = false;
    int xmp_orientation_ = 0;
    JpegMarkers out_;
};

}  // namespace

JpegMarkers jpeg_markers(Bytes bytes) {
    return MarkerScan(bytes).markers();
}

}  // namespace imgmesh
