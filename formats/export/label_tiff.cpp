// Source: TIFF 6.0, sections 2 to 4; "TIFF Technical Note 2", Adobe's deflate; the BigTIFF proposal of
// libtiff.
#include "formats/export/label_tiff.h"

#include <libdeflate.h>

#include <algorithm>
#include <new>
#include <string_view>
#include <vector>

#include "formats/files/atomic_file.h"
#include "formats/files/byte_writer.h"
#include "libcore/base/error.h"
#include "libcore/base/index.h"

namespace imgmesh {
namespace {

using Bytes = std::vector<std::uint8_t>;

void append(Bytes& out, std::uint64_t value, int count) {
    append_number(out, value, count, ByteOrder::kLittle);
}

enum FieldType : int { kAscii = 2, kShort = 3, kLong = 4, kLong8 = 16 };

constexpr int kLevel = 6;  // of deflate, as zlib's usual one
constexpr std::size_t kStrip = 256 << 10;
constexpr std::string_view kNoData("4294967295\0", 11);

}  // namespace

class LabelTiff::File {
  public:
    File(const std::string& path, int width, int height, bool overwrite)
        : file_(path, overwrite), packer_(libdeflate_alloc_compressor(kLevel), libdeflate_free_compressor) {
        if (!packer_) throw std::bad_alloc();
        width_ = as_index(width);
        height_ = as_index(height);
        rows_ = std::clamp<std::size_t>(kStrip / (width_ * sizeof(Id)), 1, height_);
        // Deflate adds next to nothing to what it cannot pack.
        is_big_ = width_ * height_ * sizeof(Id) > std::size_t{4'000'000'000};
        at_ = is_big_ ? 16 : 8;
    }

    void put(std::span<const Id> labels) {
        while (!labels.empty()) {
            const std::size_t strip = std::min(rows_, height_ - written_) * width_;
            const std::size_t part = std::min(labels.size(), strip - strip_.size() / sizeof(Id));
            if (part == 0) throw Error(ErrorKind::kInternal, "more labels than the TIFF has pixels");
            for (const Id label : labels.first(part)) append(strip_, label, 4);
            labels = labels.subspan(part);
            if (strip_.size() == strip * sizeof(Id)) write_strip();
        }
    }

    void commit() {
        if (written_ != height_) throw Error(ErrorKind::kInternal, "rows of the TIFF are missing");
        align();
        const std::uint64_t no_data_at = at_;
        write(Bytes(kNoData.begin(), kNoData.end()));
        align();
        const std::uint64_t offsets_at = write_list(offsets_), sizes_at = write_list(sizes_);
        if (is_big_) align();
        const std::uint64_t directory = at_;
        const FieldType place = is_big_ ? kLong8 : kLong;
        constexpr int kFields = 12;
        Bytes out;
        append(out, kFields, is_big_ ? 8 : 2);
        append_field(out, 256, kLong, 1, width_);
        append_field(out, 257, kLong, 1, height_);
        append_field(out, 258, kShort, 1, 32);  // bits a sample
        append_field(out, 259, kShort, 1, 8);   // deflate
        append_field(out, 262, kShort, 1, 1);   // 0 is black
        append_field(out, 273, place, offsets_.size(), offsets_at);
        append_field(out, 277, kShort, 1, 1);  // samples a pixel
        append_field(out, 278, kLong, 1, rows_);
        append_field(out, 279, place, sizes_.size(), sizes_at);
        append_field(out, 284, kShort, 1, 1);  // samples of a pixel side by side
        append_field(out, 339, kShort, 1, 1);  // unsigned integers
        append_field(out, 42113, kAscii, kNoData.size(), no_data_at);
        append(out, 0, word());
        write(out);

        Bytes head = {'I', 'I'};
        append(head, is_big_ ? 43 : 42, 2);
        if (is_big_) append(head, 8, 4);  // bytes of an offset
        append(head, directory, word());
        file_.write_at(0, head);
        file_.commit();
    }

  private:
    int word() const { return is_big_ ? 8 : 4; }

    void write(const Bytes& bytes) {
        file_.write_at(at_, bytes);
        at_ += bytes.size();
    }

    void align() {
        if (at_ % 2 != 0) write({0});
    }

    void write_strip() {
        Bytes packed(libdeflate_zlib_compress_bound(packer_.get(), strip_.size()));
        packed.resize(libdeflate_zlib_compress(packer_.get(), strip_.data(), strip_.size(), packed.data(),
                                               packed.size()));
        offsets_.push_back(at_);
        sizes_.push_back(packed.size());
        write(packed);
        written_ += std::min(rows_, height_ - written_);
        strip_.clear();
    }

    // A field of the directory. The value, or where it is, stands in one word.
    void append_field(Bytes& out, int tag, FieldType type, std::uint64_t count, std::uint64_t value) const {
        append(out, static_cast<std::uint64_t>(tag), 2);
        append(out, static_cast<std::uint64_t>(type), 2);
        append(out, count, word());
        append(out, value, word());
    }

    // Returns what the list's field holds.
    std::uint64_t write_list(const std::vector<std::uint64_t>& list) {
        const std::uint64_t place = at_;
        Bytes bytes;
        for (const std::uint64_t number : list) append(bytes, number, word());
        write(bytes);
        return list.size() == 1 ? list[0] : place;  // one number stands in the field itself
    }

    AtomicFile file_;
    std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> packer_;
    std::size_t width_ = 0, height_ = 0;
    std::size_t rows_ = 0;  // of a strip
    bool is_big_ = false;
    std::uint64_t at_ = 0;     // where the file ends
    std::size_t written_ = 0;  // rows
    Bytes strip_;              // not yet packed
    std::vector<std::uint64_t> offsets_, sizes_;
};

LabelTiff::LabelTiff(const std::string& path, int width, int height, bool overwrite)
    : file_(std::make_unique<File>(path, width, height, overwrite)) {}
LabelTiff::~LabelTiff() = default;

void LabelTiff::put(std::span<const Id> labels) {
    file_->put(labels);
}
void LabelTiff::commit() {
    file_->commit();
}

}  // namespace imgmesh
