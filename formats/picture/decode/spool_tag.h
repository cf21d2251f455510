// What a spooled picture says beside the tags of TIFF. Internal to this room.
#pragma once

#include <optional>

#include "formats/picture/color/stated_color.h"
#include "formats/picture/decode/tiff_file.h"

namespace imgmesh {

/// One of the numbers that anybody may use (TIFF 6.0, section 2). Its content begins with a word of ours.
constexpr ttag_t kSpoolTag = 65122;

/// TIFF has no words for these.
struct SpoolInfo {
    StatedColor color;
    bool inks_upside_down = false;  ///< 0 is full ink
};

std::vector<std::uint8_t> spool_tag(const SpoolInfo& info);

/// The tag of a copy of another TIFF, whose own tags say all else: a block that it leaves out is broken in
/// the original, and not without data.
std::vector<std::uint8_t> copy_tag();
bool is_copy(const TiffFile& file);

/// Makes the tag known to a file that is written, and sets it.
void set_spool_tag(TIFF* tiff, const std::vector<std::uint8_t>& tag);

/// Returns nothing for a file without the tag, and for a tag of another program.
std::optional<SpoolInfo> spool_info(const TiffFile& file);

}  // namespace imgmesh
