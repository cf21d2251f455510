#include "formats/exr/exr_metadata.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "formats/files/one_line.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

enum class Number { kFloat, kDouble, kInt, kUnsigned };

struct Type {
    std::string_view name;
    int count;
    Number number;
};
constexpr Type kTypes[] = {{"string", 0, Number::kInt},       {"int", 1, Number::kInt},
                           {"float", 1, Number::kFloat},      {"double", 1, Number::kDouble},
                           {"v2i", 2, Number::kInt},          {"v2f", 2, Number::kFloat},
                           {"v3i", 3, Number::kInt},          {"v3f", 3, Number::kFloat},
                           {"box2i", 4, Number::kInt},        {"box2f", 4, Number::kFloat},
                           {"m33f", 9, Number::kFloat},       {"m44f", 16, Number::kFloat},
                           {"rational", 2, Number::kInt},     {"chromaticities", 8, Number::kFloat},
                           {"timecode", 2, Number::kUnsigned}};

// They say how the pixels are stored, or belong to parts that are not written.
constexpr std::string_view kStructural[] = {"channels",
                                            "compression",
                                            "lineOrder",
                                            "tiles",
                                            "type",
                                            "name",
                                            "version",
                                            "view",
                                            "preview",
                                            "multiView",
                                            "maxSamplesPerPixel",
                                            "chunkCount",
                                            "dwaCompressionLevel",
                                            "acesImageContainerFlag"};

// Every header has these, of one type.
constexpr std::pair<std::string_view, std::string_view> kFixed[] = {
    {"displayWindow", "box2i"},    {"dataWindow", "box2i"},        {"pixelAspectRatio", "float"},
    {"screenWindowCenter", "v2f"}, {"screenWindowWidth", "float"}, {"chromaticities", "chromaticities"}};

const Type* find_type(std::string_view name) {
    const auto at = std::ranges::find(kTypes, name, &Type::name);
    return at == std::end(kTypes) ? nullptr : &*at;
}

bool fits(double x, Number number) {
    const auto whole = [&](double least, double most) {
        return x >= least && x <= most && x == std::floor(x);
    };
    switch (number) {
        case Number::kInt:
            return whole(std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::max());
        case Number::kUnsigned:
            return whole(0, std::numeric_limits<std::uint32_t>::max());
        case Number::kFloat:
            return std::abs(x) <= double{std::numeric_limits<float>::max()};
        case Number::kDouble:
            break;
    }
    return std::isfinite(x);
}

// Whether it is UTF-8 (RFC 3629), without control characters except those of `allowed`.
bool is_text(std::string_view text, std::string_view allowed) {
    for (std::size_t i = 0; i < text.size();) {
        const auto byte = [&](std::size_t k) {
            return i + k < text.size() ? static_cast<unsigned char>(text[i + k]) : 0u;
        };
        const unsigned first = byte(0);
        const std::size_t size = first < 0x80 ? 1 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
        if (first >= 0xF8 || (first >= 0x80 && first < 0xC2)) return false;
        std::uint32_t code = size == 1 ? first : first & (0x7Fu >> size);
        for (std::size_t k = 1; k < size; ++k) {
            if ((byte(k) & 0xC0) != 0x80) return false;
            code = code << 6 | (byte(k) & 0x3F);
        }
        constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
        const bool control = code < 0x20 || (code >= 0x7F && code < 0xA0);
        if (code < kLeast[size] || code > 0x10FFFF || (code >= 0xD800 && code < 0xE000)) return false;
        if (control && allowed.find(static_cast<char>(code)) == std::string_view::npos) return false;
        i += size;
    }
    return true;
}

std::string fault_of_value(const ExrAttribute& a) {
    // OpenEXR refuses what is beyond these.
    constexpr double kMostCoordinate = (1 << 30) - 2;
    constexpr double kLeastAspect = 1e-6, kMostAspect = 1e6;
    const std::vector<double>& n = a.numbers;
    if (a.name.ends_with("Window") && a.type == "box2i" &&
        (n[2] < n[0] || n[3] < n[1] ||
         std::ranges::any_of(n, [&](double x) { return std::abs(x) > kMostCoordinate; })))
        return "is no window";
    if (a.name == "pixelAspectRatio" && !(n[0] >= kLeastAspect && n[0] <= kMostAspect)) return "is no ratio";
    if (a.name == "screenWindowWidth" && !(n[0] >= 0)) return "is below 0";
    return "";
}

}  // namespace

bool is_exr_storage(std::string_view name) {
    return std::ranges::count(kStructural, name) > 0 || name.starts_with("imgmesh:");
}

std::size_t exr_attribute_bytes(const ExrAttribute& a) {
    return a.name.size() + a.type.size() + a.text.size() + a.numbers.size() * sizeof(double);
}

int exr_number_count(std::string_view type) {
    const Type* const found = find_type(type);
    return found ? found->count : -1;
}

std::string exr_attribute_fault(const ExrAttribute& a) {
    constexpr std::size_t kMaxName = 255;
    if (a.name.empty() || a.name.size() > kMaxName || !is_text(a.name, ""))
        return cat("an attribute has a name that is none: ", printable(a.name));
    const auto fault = [&](const std::string& what) {
        return cat("attribute ", printable(a.name), " ", what);
    };
    if (is_exr_storage(a.name)) return fault("says how an EXR is stored");
    const Type* const type = find_type(a.type);
    if (!type) return fault(cat("has the type ", printable(a.type), ", which is not kept"));
    for (const auto& [name, expected] : kFixed)
        if (a.name == name && a.type != expected) return fault(cat("has not the type ", expected));
    if (!is_text(a.text, "\t\n\r") || (type->count > 0 && !a.text.empty()))
        return fault("has a text that is not UTF-8, or has control characters");
    if (std::ssize(a.numbers) != type->count) return fault(cat("has not ", type->count, " numbers"));
    for (const double x : a.numbers)
        if (!fits(x, type->number)) return fault(cat("has a number that is no ", a.type, "'s"));
    const std::string value = fault_of_value(a);
    return value.empty() ? "" : fault(value);
}

std::string exr_metadata_fault(const ExrMetadata& metadata, int width, int height) {
    if (metadata.size() > kMaxMetadataEntries)
        return cat(metadata.size(), " attributes, at most ", kMaxMetadataEntries);
    std::size_t bytes = 0;
    for (std::size_t i = 0; i < metadata.size(); ++i) {
        if (const std::string fault = exr_attribute_fault(metadata[i]); !fault.empty()) return fault;
        if (i > 0 && metadata[i].name <= metadata[i - 1].name) return "the attributes are not sorted";
        bytes += exr_attribute_bytes(metadata[i]);
    }
    if (bytes > kMaxMetadataBytes) return cat(bytes, " bytes of attributes, at most ", kMaxMetadataBytes);
    if (const ExrAttribute* const shown = find_attribute(metadata, "displayWindow")) {
        const std::vector<double>& n = shown->numbers;
        if (n[2] - n[0] + 1 != width || n[3] - n[1] + 1 != height)
            return "attribute displayWindow is not of the image's size";
    }
    return "";
}

const ExrAttribute* find_attribute(const ExrMetadata& metadata, std::string_view name) {
    const auto at = std::ranges::find(metadata, name, &ExrAttribute::name);
    return at == metadata.end() ? nullptr : &*at;
}

}  // namespace imgmesh
