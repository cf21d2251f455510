// Source: "OpenEXR File Layout", sections "Version field", "Header" and "Attribute types".
#include "formats/exr/exr_opaque.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "libcore/base/error.h"

namespace imgmesh {
namespace {

constexpr std::uint32_t kMultiPart = 0x1000, kDeep = 0x800;

// What OpenEXR reads with this size, whatever the header says.
constexpr std::pair<std::string_view, std::uint32_t> kFixedSizes[] = {
    {"box2f", 16},      {"box2i", 16},    {"chromaticities", 32},
    {"compression", 1}, {"double", 8},    {"float", 4},
    {"int", 4},         {"lineOrder", 1}, {"m33f", 36},
    {"m44f", 64},       {"tiledesc", 9},  {"v2f", 8},
    {"v2i", 8},         {"v3f", 12},      {"v3i", 12}};

class Walker {
  public:
    Walker(const std::string& path, std::span<std::uint8_t> bytes) : path_(path), bytes_(bytes) {}

    std::span<std::uint8_t> take(std::size_t count) {
        if (count > bytes_.size() - at_)
            throw Error(ErrorKind::kBadFile, cat(path_, ": the EXR ends in its header"));
        at_ += count;
        return bytes_.subspan(at_ - count, count);
    }
    std::uint32_t number() {
        const auto b = take(4);
        return b[0] | std::uint32_t{b[1]} << 8 | std::uint32_t{b[2]} << 16 | std::uint32_t{b[3]} << 24;
    }
    // Zero-terminated; without the zero.
    std::span<std::uint8_t> name() {
        const std::size_t start = at_;
        while (take(1)[0] != 0) {
        }
        return bytes_.subspan(start, at_ - 1 - start);
    }
    // Steps over the empty name that ends a list, if here is one.
    bool ends() {
        if (take(1)[0] == 0) return true;
        --at_;
        return false;
    }
    bool done() const { return at_ == bytes_.size(); }

  private:
    const std::string& path_;
    std::span<std::uint8_t> bytes_;
    std::size_t at_ = 0;
};

// OpenEXR goes by the empty name at the list's end, not by its size.
bool is_channel_list(const std::string& path, std::span<std::uint8_t> value) {
    constexpr std::size_t kChannelBytes = 16;  // type, linearity, sampling
    Walker in(path, value);
    while (!in.ends()) {
        in.name();
        in.take(kChannelBytes);
    }
    return in.done();
}

bool is_safe(const std::string& path, std::string_view type, std::span<std::uint8_t> value) {
    if (type == "string") return true;
    if (type == "chlist") return is_channel_list(path, value);
    return std::ranges::any_of(
        kFixedSizes, [&](const auto& known) { return known.first == type && known.second == value.size(); });
}

}  // namespace

void make_attributes_opaque(const std::string& path, std::span<std::uint8_t> bytes) {
    Walker in(path, bytes);
    in.number();  // the signature
    const std::uint32_t version = in.number();
    if ((version & 0xFF) != 2)
        throw Error(ErrorKind::kBadFile, cat(path, ": EXR version ", version & 0xFF, ", expected 2"));
    if (version & kDeep)
        throw Error(ErrorKind::kUnsupported, cat(path, ": deep EXR images are not supported"));
    // An empty name ends a header, and an empty header those of a file with many parts.
    do {
        while (!in.ends()) {
            in.name();
            const std::span<std::uint8_t> type = in.name();
            const std::span<std::uint8_t> value = in.take(in.number());
            const std::string_view text(reinterpret_cast<const char*>(type.data()), type.size());
            if (!type.empty() && !is_safe(path, text, value)) type[0] = '~';  // no type begins so
        }
    } while ((version & kMultiPart) && !in.ends());
}

}  // namespace imgmesh
