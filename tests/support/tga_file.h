// TGA files, field by field.
#pragma once

#include <optional>
#include <string>

#include "tests/support/file_bytes.h"

namespace imgmesh {

struct Tga {
    int type = 2;
    int bits = 24;
    int descriptor = 0x20;  // from the top left, no attribute bits
    FileBytes pixels = {};
    int width = 2, height = 2;
    std::string id = {};
    int palette_first = 0, palette_size = 0, palette_bits = 0;
    FileBytes palette = {};
    std::optional<int> attributes = {};  // adds version 2's extension

    FileBytes file() const {
        FileBytes out;
        out.put({static_cast<int>(id.size()), palette_size > 0 ? 1 : 0, type});
        out.little(static_cast<std::uint32_t>(palette_first), 2)
            .little(static_cast<std::uint32_t>(palette_size), 2);
        out.put({palette_bits, 0, 0, 0, 0}).little(static_cast<std::uint32_t>(width), 2);
        out.little(static_cast<std::uint32_t>(height), 2).put({bits, descriptor});
        out.put(FileBytes(id)).put(palette).put(pixels);
        if (attributes) {
            const auto at = static_cast<std::uint32_t>(out.bytes.size());
            out.little(495, 2).zeros(492).put({*attributes});
            out.little(at, 4).little(0, 4).put(FileBytes(std::string_view("TRUEVISION-XFILE.\0", 18)));
        }
        return out;
    }
};

}  // namespace imgmesh
