#include "formats/picture/sample_codes.h"

#include <algorithm>
#include <limits>

#include "libcore/base/parallel.h"

namespace imgmesh {
namespace {

constexpr std::size_t kBlock = 1 << 16;

// Calls body(begin, end) for blocks of [0, size).
template <typename Body>
void for_blocks(std::size_t size, const Body& body) {
    parallel_blocks(0, static_cast<int>((size + kBlock - 1) / kBlock), 1, [&](int first, int last) {
        body(static_cast<std::size_t>(first) * kBlock,
             std::min(static_cast<std::size_t>(last) * kBlock, size));
    });
}

template <typename Code>
void to_floats(std::span<const Code> codes, std::span<float> out) {
    for_blocks(codes.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            out[i] = static_cast<float>(codes[i]) / float(std::numeric_limits<Code>::max());
    });
}

// Truncation and a comparison are exact and, unlike lround(), vectorise.
template <typename Code>
std::vector<Code> to_codes(std::span<const float> values) {
    constexpr float kMax = std::numeric_limits<Code>::max();
    std::vector<Code> codes(values.size());
    for_blocks(values.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const float positive = values[i] > 0 ? values[i] : 0.0f;
            const float scaled = kMax * (positive < 1 ? positive : 1.0f);
            const auto whole = static_cast<std::int32_t>(scaled);
            codes[i] = static_cast<Code>(whole + (scaled - static_cast<float>(whole) >= 0.5f ? 1 : 0));
        }
    });
    return codes;
}

}  // namespace

void floats_from_codes(std::span<const std::uint8_t> codes, std::span<float> out) {
    to_floats(codes, out);
}
void floats_from_codes(std::span<const std::uint16_t> codes, std::span<float> out) {
    to_floats(codes, out);
}
std::vector<std::uint8_t> codes8_from_floats(std::span<const float> values) {
    return to_codes<std::uint8_t>(values);
}
std::vector<std::uint16_t> codes16_from_floats(std::span<const float> values) {
    return to_codes<std::uint16_t>(values);
}

}  // namespace imgmesh
