// What an EXR says about its image beside the pixels: attributes of its header, as values.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace imgmesh {

/// An attribute of a header. `type` is OpenEXR's name of it, one of string, int, float, double, v2i, v2f,
/// v3i, v3f, box2i, box2f, m33f, m44f, chromaticities, rational and timecode.
struct ExrAttribute {
    std::string name;
    std::string type;
    std::string text = {};             ///< of a string
    std::vector<double> numbers = {};  ///< of all others, in the order of the file
    bool operator==(const ExrAttribute&) const = default;
};

/// Sorted by name, each name once. Only what a header need not have: the windows if one of them does not
/// begin at (0, 0) or they differ, pixelAspectRatio and its like if they are unusual.
using ExrMetadata = std::vector<ExrAttribute>;

/// All of it together has no more, names and texts in bytes and 8 for a number.
inline constexpr std::size_t kMaxMetadataBytes = std::size_t{1} << 16;
inline constexpr std::size_t kMaxMetadataEntries = 256;

/// How many numbers an attribute of this type has; 0 for a string, -1 for types that are not kept.
int exr_number_count(std::string_view type);

/// Whether an attribute of that name says how pixels are stored, or in which parts; those are not kept.
bool is_exr_storage(std::string_view name);

/// How much of kMaxMetadataBytes the attribute takes.
std::size_t exr_attribute_bytes(const ExrAttribute& attribute);

/// Returns what is wrong with an attribute, or "": its name (1 to 255 bytes, printable, no is_exr_storage()),
/// its type, text (UTF-8 without control characters but tab and line ends) and numbers.
std::string exr_attribute_fault(const ExrAttribute& attribute);

/// Returns what is wrong with the whole, or "": an attribute, the order, the limits, a display window that is
/// not of the image's size.
std::string exr_metadata_fault(const ExrMetadata& metadata, int width, int height);

/// The attribute of that name; null if there is none.
const ExrAttribute* find_attribute(const ExrMetadata& metadata, std::string_view name);

}  // namespace imgmesh
