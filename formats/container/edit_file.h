// Files of edits: JSON as schemas/imgmesh-warp.edits.schema.json describes it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "libcore/warp/warp_edits.h"

namespace imgmesh {

/// read_edits() refuses larger files before it takes memory for them.
struct EditLimits {
    std::uint64_t max_bytes = std::uint64_t{16} << 20;
    int max_json_depth = 16;
    std::size_t max_json_values = std::size_t{1} << 21;  ///< objects, arrays, numbers, ...
};

/// Reads a file of edits. Every `where` becomes the path and a JSON pointer: "edits.json: /edits/0/pins/1".
///
/// Safe for any bytes. Throws Error: kIo if the file cannot be read; kBadFile for a file that is too
/// large, too deep, no JSON or not as the schema says. The text has the place: line and column, or a JSON
/// pointer. Whether the levels and vertices exist is checked by solve_edits().
WarpEdits read_edits(const std::string& path, const EditLimits& limits = {});

/// As read_edits(), from the text of a file; `name` stands for its path.
WarpEdits edits_from_json(std::string_view text, const std::string& name, const EditLimits& limits = {});

}  // namespace imgmesh
