// Source: "OpenEXR File Layout", sections "Magic number", "Version field" and "Header".
#include "formats/exr/exr_header.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "formats/findings/findings.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

constexpr std::uint32_t kMagic = 20000630;
constexpr std::uint32_t kFlagTiled = 0x200, kFlagLongNames = 0x400, kFlagMultiPart = 0x1000;
constexpr std::size_t kMaxName = 255;
constexpr std::uint32_t kMaxAttributeBytes = 65536;
constexpr int kMaxAttributes = 1000;

// OpenEXR reads attributes of these types with their natural size whatever size the header says, so another
// size would set it off from this walk.
constexpr std::pair<std::string_view, std::uint32_t> kFixedSizes[] = {
    {"box2f", 16},   {"box2i", 16},   {"chromaticities", 32}, {"compression", 1}, {"double", 8},
    {"float", 4},    {"int", 4},      {"lineOrder", 1},       {"m33f", 36},       {"m44f", 64},
    {"rational", 8}, {"tiledesc", 9}, {"timecode", 8},        {"v2f", 8},         {"v2i", 8},
    {"v3f", 12},     {"v3i", 12}};

class Walker {
  public:
    explicit Walker(std::span<const std::uint8_t> bytes, std::uint64_t start = 0)
        : rest_(bytes), end_(start + bytes.size()) {}

    std::uint32_t number() {
        const auto b = take(4);
        return b[0] | std::uint32_t{b[1]} << 8 | std::uint32_t{b[2]} << 16 | std::uint32_t{b[3]} << 24;
    }
    // Zero-terminated.
    std::string_view name() {
        const std::size_t search = std::min(rest_.size(), kMaxName + 1);
        const auto end = std::find(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(search), 0);
        const auto length = static_cast<std::size_t>(end - rest_.begin());
        if (length == search) refuse("layers.header", "a name in the EXR's header does not end", place());
        const auto b = take(length + 1);
        return {reinterpret_cast<const char*>(b.data()), length};
    }
    std::span<const std::uint8_t> take(std::size_t count) {
        if (count > rest_.size()) refuse("layers.header", "the EXR ends in its header", place());
        const auto taken = rest_.first(count);
        rest_ = rest_.subspan(count);
        return taken;
    }
    // At the zero byte that ends a header or a list of channels.
    bool at_end() const { return !rest_.empty() && rest_[0] == 0; }
    std::size_t left() const { return rest_.size(); }
    std::uint64_t offset() const { return end_ - rest_.size(); }
    Place place() const { return at_byte("layers", offset()); }

  private:
    std::span<const std::uint8_t> rest_;
    std::uint64_t end_;  // offset of the end in the file
};

// A channel list ends with an empty name; OpenEXR goes by that and not by the size either.
bool is_channel_list(std::span<const std::uint8_t> value, std::uint64_t start) {
    constexpr std::size_t kChannelBytes = 16;  // type, linearity, sampling
    Walker in(value, start);
    while (!in.at_end()) {
        in.name();
        in.take(kChannelBytes);
    }
    return in.left() == 1;
}

void check_attribute(std::string_view type, std::span<const std::uint8_t> value, std::uint64_t start) {
    if (type == "string") return;
    if (type == "chlist" && is_channel_list(value, start)) return;
    for (const auto& [known, size] : kFixedSizes)
        if (type == known && value.size() == size) return;
    refuse("layers.attribute",
           cat("the EXR has an attribute of type ", type, " with ", value.size(), " bytes"),
           at_byte("layers", start));
}

void check_part(Walker& in) {
    for (int i = 0; !in.at_end(); ++i) {
        if (i == kMaxAttributes)
            refuse("layers.header", cat("more than ", kMaxAttributes, " attributes"), in.place());
        in.name();
        const std::string_view type = in.name();
        const std::uint32_t size = in.number();
        if (size > kMaxAttributeBytes)
            refuse("layers.attribute", cat("an attribute of ", size, " bytes, at most ", kMaxAttributeBytes),
                   in.place());
        const std::uint64_t start = in.offset();
        check_attribute(type, in.take(size), start);
    }
    in.take(1);
}

}  // namespace

void check_exr_header(std::span<const std::uint8_t> bytes, int max_parts) {
    Walker in(bytes);
    if (in.number() != kMagic) refuse("layers.magic", "the layers are not an EXR file", at_byte("layers", 0));
    const std::uint32_t version = in.number(), flags = version & ~0xFFu;
    if ((version & 0xFF) != 2)
        refuse("layers.magic", cat("EXR version ", version & 0xFF, ", expected 2"), at_byte("layers", 4));
    if (flags & ~(kFlagTiled | kFlagLongNames | kFlagMultiPart))
        refuse("layers.type", "the EXR has deep parts or unknown flags", at_byte("layers", 4));
    check_part(in);
    if (!(flags & kFlagMultiPart)) return;
    for (int parts = 1; !in.at_end(); ++parts) {
        if (parts == max_parts)
            refuse("layers.parts", cat("the EXR has more than ", max_parts, " parts"), in.place());
        check_part(in);
    }
}

}  // namespace imgmesh
