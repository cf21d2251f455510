#include "formats/exr/exr_attributes.h"

#include <algorithm>
#include <utility>

#include "formats/files/byte_reader.h"

namespace imgmesh {
namespace {

constexpr std::pair<std::string_view, std::size_t> kFixedSizes[] = {
    {"box2f", 16},   {"box2i", 16},   {"chromaticities", 32}, {"compression", 1}, {"double", 8},
    {"float", 4},    {"int", 4},      {"lineOrder", 1},       {"m33f", 36},       {"m44f", 64},
    {"rational", 8}, {"tiledesc", 9}, {"timecode", 8},        {"v2f", 8},         {"v2i", 8},
    {"v3f", 12},     {"v3i", 12}};

bool is_channel_list(std::span<const std::uint8_t> value, std::size_t position) {
    constexpr std::size_t kChannelBytes = 16;  // type, linearity, sampling
    ByteReader in(value, ByteOrder::kLittle, position);
    while (!in.take_if(0)) {
        if (!in.terminated_text(value.size())) throw EndOfBytes{in.position()};
        in.take(kChannelBytes);
    }
    return in.left() == 0;
}

}  // namespace

bool has_natural_size(std::string_view type, std::span<const std::uint8_t> value, std::size_t position) {
    if (type == "string") return true;
    if (type == "chlist") return is_channel_list(value, position);
    return std::ranges::any_of(
        kFixedSizes, [&](const auto& known) { return known.first == type && known.second == value.size(); });
}

}  // namespace imgmesh
