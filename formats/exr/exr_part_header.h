// What the header of an EXR's part says, as far as layers need it. Private to this folder and web/ports.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace imgmesh {

/// Numbered as in the file, as compressions are.
enum class ExrSample { kUint, kHalf, kFloat };
inline constexpr int kExrUncompressed = 0, kExrZips = 2, kExrZip = 3;
inline constexpr int kExrZipRows = 16;  ///< of a block

struct ExrPartChannel {
    std::string name;
    ExrSample type = ExrSample::kFloat;
    int x_sampling = 1, y_sampling = 1;
    bool is_linear = false;  ///< "perceptually", of which only lossy compressions take note
};

/// The corners belong to it.
struct ExrWindow {
    int min_x = 0, min_y = 0, max_x = 0, max_y = 0;
    bool operator==(const ExrWindow&) const = default;
};

struct ExrTiles {
    unsigned width = 0, height = 0;
    bool has_one_level = false;
};

struct ExrPartHeader {
    std::optional<std::string> name, type;
    std::optional<ExrTiles> tiles;
    ExrWindow data, shown;
    int compression = kExrZip;
    std::vector<ExrPartChannel> channels;          ///< sorted by name
    std::optional<std::string> version, topology;  ///< imgmesh's own

    /// Null if there is none.
    const ExrPartChannel* channel(std::string_view wanted) const {
        for (const ExrPartChannel& c : channels)
            if (c.name == wanted) return &c;
        return nullptr;
    }
};

inline constexpr int sample_bytes(ExrSample type) {
    return type == ExrSample::kHalf ? 2 : 4;
}

}  // namespace imgmesh
