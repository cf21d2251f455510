// The header of a PAM file of Netpbm. Internal to this folder.
#pragma once

#include <cstdint>
#include <string>

#include "formats/picture/decode/pnm_text.h"

namespace imgmesh {

struct PamHeader {
    std::int64_t width = 0, height = 0, depth = 0, largest = 0;
    std::string type;  ///< all TUPLTYPE, with spaces between them
};

/// Takes it, to the line feed before the pixels. Throws Error(kBadFile). Sizes are as stated, not checked.
PamHeader pam_header(const std::string& path, PnmText& text);

}  // namespace imgmesh
