// Source: "OpenEXR File Layout".
#include "formats/exr/exr_output.h"

#include <bit>
#include <cstring>
#include <string_view>

#include "formats/exr/exr_attributes.h"
#include "formats/exr/exr_part_checks.h"
#include "formats/files/byte_writer.h"

namespace imgmesh {
namespace {

using Bytes = std::vector<std::uint8_t>;

class HeaderWriter {
  public:
    explicit HeaderWriter(Bytes& out) : out_(out) {}

    void number(std::uint64_t value, int count = 4) { append_number(out_, value, count, ByteOrder::kLittle); }
    void text(std::string_view text) {
        out_.insert(out_.end(), text.begin(), text.end());
        out_.push_back(0);
    }
    void attribute(std::string_view name, std::string_view type, std::size_t size) {
        text(name);
        text(type);
        number(size);
    }
    void numbers(std::string_view name, std::string_view type, std::initializer_list<std::uint32_t> values) {
        attribute(name, type, 4 * values.size());
        for (const std::uint32_t value : values) number(value);
    }
    void byte(std::string_view name, std::string_view type, int value) {
        attribute(name, type, 1);
        number(static_cast<std::uint64_t>(value), 1);
    }
    void words(std::string_view name, std::string_view words) {
        attribute(name, "string", words.size());
        out_.insert(out_.end(), words.begin(), words.end());
    }
    void window(std::string_view name, const ExrWindow& w) {
        const auto word = [](int value) { return static_cast<std::uint32_t>(value); };
        numbers(name, "box2i", {word(w.min_x), word(w.min_y), word(w.max_x), word(w.max_y)});
    }
    void channels(const std::vector<ExrPartChannel>& channels) {
        std::size_t size = 1;
        for (const ExrPartChannel& c : channels) size += c.name.size() + 1 + 16;
        attribute("channels", "chlist", size);
        for (const ExrPartChannel& c : channels) {
            text(c.name);
            number(static_cast<std::uint64_t>(c.type));
            number(c.is_linear ? 1 : 0);  // and three bytes that are reserved
            number(static_cast<std::uint64_t>(c.x_sampling));
            number(static_cast<std::uint64_t>(c.y_sampling));
        }
        number(0, 1);
    }

  private:
    Bytes& out_;
};

int block_rows(const ExrPartHeader& part) {
    return part.compression == kExrZip ? kExrZipRows : 1;
}

std::size_t block_count(const ExrPartHeader& part) {
    const int rows = block_rows(part), height = part.data.max_y - part.data.min_y + 1;
    return static_cast<std::size_t>((height + rows - 1) / rows);
}

}  // namespace

class ExrOutput::File {
  public:
    explicit File(Bytes& bytes) : out_(bytes) {}

    void add_part(const ExrPartHeader& part) { parts_.push_back(part); }

    void write_block(std::size_t part, int row, std::span<const std::uint8_t> packed) {
        if (tables_.empty()) write_headers();
        const std::size_t block =
            static_cast<std::size_t>((row - parts_[part].data.min_y) / block_rows(parts_[part]));
        put(tables_[part] + 8 * block, out_.size());
        HeaderWriter out(out_);
        if (parts_.size() > 1) out.number(part);
        out.number(static_cast<std::uint32_t>(row));
        out.number(packed.size());
        out_.insert(out_.end(), packed.begin(), packed.end());
    }

  private:
    void put(std::size_t at, std::uint64_t value) {
        for (std::size_t i = 0; i < 8; ++i) out_[at + i] = static_cast<std::uint8_t>(value >> 8 * i);
    }

    void write_headers() {
        const bool many = parts_.size() > 1;
        HeaderWriter out(out_);
        out.number(kExrMagic);
        out.number(kExrVersion | (many ? kExrMultiPart : 0));
        for (const ExrPartHeader& part : parts_) {
            out.channels(part.channels);
            out.byte("compression", "compression", part.compression);
            out.window("dataWindow", part.data);
            out.window("displayWindow", part.shown);
            out.byte("lineOrder", "lineOrder", 0);
            if (part.name) out.words("name", *part.name);
            const auto one = std::bit_cast<std::uint32_t>(1.0f);
            out.numbers("pixelAspectRatio", "float", {one});
            out.numbers("screenWindowCenter", "v2f", {0, 0});
            out.numbers("screenWindowWidth", "float", {one});
            out.words("type", "scanlineimage");
            if (many) out.numbers("chunkCount", "int", {static_cast<std::uint32_t>(block_count(part))});
            if (part.version) out.words(kVersionName, *part.version);
            if (part.topology) out.words(kTopologyName, *part.topology);
            out.number(0, 1);
        }
        if (many) out.number(0, 1);
        for (const ExrPartHeader& part : parts_) {
            tables_.push_back(out_.size());
            out_.resize(out_.size() + 8 * block_count(part));
        }
    }

    Bytes& out_;
    std::vector<ExrPartHeader> parts_;
    std::vector<std::size_t> tables_;  // where each part's begins
};

ExrOutput::ExrOutput(Bytes& bytes) : file_(std::make_unique<File>(bytes)) {}
ExrOutput::~ExrOutput() = default;

void ExrOutput::add_part(const ExrPartHeader& part) {
    file_->add_part(part);
}

void ExrOutput::write_block(std::size_t part, int row, std::span<const std::uint8_t> packed) {
    file_->write_block(part, row, packed);
}

void ExrOutput::finish() {}

}  // namespace imgmesh
