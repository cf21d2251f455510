// Source: PNG, third edition (W3C, 2025), sections 5, 11 and 12.
#include "formats/picture/decode/png_chunks.h"

#include <libdeflate.h>

#include <algorithm>

#include "formats/files/byte_reader.h"
#include "formats/files/one_line.h"
#include "formats/picture/decode/png_text.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

using Bytes = std::span<const std::uint8_t>;

struct Chunk {
    std::string_view name;
    Bytes content;
    bool checked;  ///< its checksum is right
};

class PngScan {
  public:
    PngScan(const std::string& path, Bytes bytes) : path_(path), in_(bytes, ByteOrder::kBig) {}

    PngParts parts() {
        in_.take(8);  // the signature
        while (next_chunk()) {
            if (chunk_.name == "IEND") break;
            if (chunk_.name == "CgBI")
                throw Error(
                    ErrorKind::kUnsupported,
                    cat(path_,
                        ": PNG files of iOS (CgBI) are not supported; convert it back, for example by "
                        "pngcrush -revert-iphone-optimizations"));
            if (parts_.width == 0 && chunk_.name != "IHDR") throw broken("it does not start with its header");
            use();
        }
        if (parts_.width == 0) throw broken("it has no header");
        if (parts_.pixels.empty()) throw broken("it has no pixels");
        if ((parts_.color_type & 1) && parts_.palette.empty()) throw broken("its palette is missing");
        if (parts_.orientation == 0) parts_.orientation = text_.orientation();
        return std::move(parts_);
    }

  private:
    Error broken(const std::string& what) const {
        return {ErrorKind::kBadFile, cat(path_, ": the PNG is broken: ", what)};
    }
    void warn_of(const char* what) {
        parts_.warnings.push_back(cat("its chunk ", chunk_.name, " ", what, " and is not used"));
    }

    // Returns whether there is one. A chunk of pixels may be cut short by the end of the file.
    bool next_chunk() {
        parts_.complete = in_.left() >= 12;
        if (in_.left() < 8) return false;
        const std::uint32_t length = in_.number(4);
        chunk_.name = text_of(in_.take(4));
        if (!std::ranges::all_of(chunk_.name, [](char c) { return (c | 32) >= 'a' && (c | 32) <= 'z'; })) {
            if (parts_.pixels.empty()) throw broken("a chunk has no name");
            parts_.complete = false;  // what lies behind the pixels does not matter
            return false;
        }
        const auto here = std::min<std::size_t>(length, in_.left());
        chunk_.content = in_.take(here);
        parts_.complete = in_.left() >= 4;
        chunk_.checked = false;
        if (here < length || in_.left() < 4) {
            in_.take(in_.left());
            return chunk_.name == "IDAT";
        }
        const std::uint32_t checksum = in_.number(4);
        if (is_used()) {
            // The name lies before the content.
            const std::uint8_t* const start = chunk_.content.data() - 4;
            chunk_.checked = libdeflate_crc32(0, start, here + 4) == checksum;
        }
        return true;
    }

    bool is_used() const {
        static constexpr std::string_view kUsed[] = {"IHDR", "PLTE", "tRNS", "IDAT", "cICP", "iCCP", "sRGB",
                                                     "cHRM", "gAMA", "eXIf", "tEXt", "zTXt", "iTXt"};
        return std::ranges::count(kUsed, chunk_.name) > 0;
    }

    void use() {
        const std::string_view name = chunk_.name;
        if (name == "IHDR") return use_header();
        if (name == "IDAT") {
            parts_.pixels.push_back(chunk_.content);
            parts_.pixels_checked = parts_.pixels_checked && chunk_.checked;
        } else if (name == "PLTE") {
            if (!chunk_.checked) throw broken("the checksum of its palette is wrong");
            if (chunk_.content.empty() || chunk_.content.size() % 3 != 0 || chunk_.content.size() > 768)
                throw broken(cat("its palette has ", chunk_.content.size(), " bytes"));
            if (parts_.palette.empty()) parts_.palette = chunk_.content;
        } else if (name == "tRNS") {
            if (!chunk_.checked) throw broken("the checksum of its transparency is wrong");
            if (parts_.transparency.empty()) parts_.transparency = chunk_.content;
        } else if (!(name[0] & 32)) {
            throw Error(ErrorKind::kUnsupported, cat(path_, ": the PNG has a chunk ", name,
                                                     ", without which it cannot be read, and which is "
                                                     "not one of PNG's"));
        } else if (name == "tEXt" || name == "zTXt" || name == "iTXt") {
            if (chunk_.checked) text_.add(name, chunk_.content);  // else it is only text
        } else if (is_used()) {
            if (!chunk_.checked) return warn_of("has a wrong checksum");
            use_statement();
        }
    }

    void use_header() {
        if (parts_.width != 0) throw broken("it has two headers");
        if (chunk_.content.size() != 13 || !chunk_.checked)
            throw broken("the checksum of its header is wrong");
        const ByteReader header(chunk_.content, ByteOrder::kBig);
        parts_.width = header.number_at(0, 4);
        parts_.height = header.number_at(4, 4);
        parts_.depth = chunk_.content[8];
        parts_.color_type = chunk_.content[9];
        parts_.interlaced = chunk_.content[12] == 1;
        const int depth = parts_.depth, type = parts_.color_type;
        const bool byte = depth == 8, word = depth == 16, bits = depth == 1 || depth == 2 || depth == 4;
        const bool known = type == 0                             ? bits || byte || word
                           : type == 3                           ? bits || byte
                           : type == 2 || type == 4 || type == 6 ? byte || word
                                                                 : false;
        if (!known) throw broken(cat("colour type ", type, " with ", depth, " bits"));
        if (chunk_.content[10] != 0 || chunk_.content[11] != 0 || chunk_.content[12] > 1)
            throw broken("its compression, filters or interlacing are unknown");
        constexpr std::uint32_t kMost = 0x7FFFFFFF;
        if (parts_.width < 1 || parts_.height < 1 || parts_.width > kMost || parts_.height > kMost)
            throw broken(cat("the image is ", parts_.width, "x", parts_.height));
    }

    void use_statement() {
        const Bytes b = chunk_.content;
        const ByteReader in(b, ByteOrder::kBig);
        StatedColor& color = parts_.color;
        if (chunk_.name == "cICP") {
            constexpr std::uint8_t kRgb = 0, kFullRange = 1;
            if (b.size() != 4 || b[2] != kRgb || b[3] != kFullRange)
                return warn_of("states no RGB of full range");
            color.code_points = CodePoints{b[0], b[1]};
        } else if (chunk_.name == "iCCP") {
            const std::size_t name = text_of(b).find('\0');
            if (name < 80 && name + 2 < b.size()) color.icc = inflated(b.subspan(name + 2), kMaxProfile);
            if (color.icc.empty()) return warn_of("does not unpack");
        } else if (chunk_.name == "sRGB") {
            color.name = "sRGB";
        } else if (chunk_.name == "gAMA") {
            if (b.size() == 4 && in.number_at(0, 4) > 0)
                color.gamma = 1e5f / static_cast<float>(in.number_at(0, 4));
        } else if (chunk_.name == "cHRM") {
            if (b.size() != 32) return warn_of("has another size than its own");
            Chromaticities xy;
            for (std::size_t i = 0; i < xy.size(); ++i) xy[i] = in.number_at(4 * i, 4) / 1e5;
            color.chromaticities = xy;
        } else {
            parts_.orientation = exif_facts(b).orientation;
        }
    }

    static constexpr std::size_t kMaxProfile = std::size_t{16} << 20;

    const std::string& path_;
    ByteReader in_;
    Chunk chunk_ = {};
    PngText text_;
    PngParts parts_;
};

}  // namespace

PngParts png_parts(const std::string& path, Bytes bytes) {
    return PngScan(path, bytes).parts();
}

}  // namespace imgmesh
