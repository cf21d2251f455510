// BMP files, field by field.
#pragma once

#include <optional>
#include <vector>

#include "tests/support/file_bytes.h"

namespace imgmesh {

struct Bmp {
    int width = 2, height = 2;
    int bits = 24;
    std::uint32_t compression = 0;
    std::uint32_t header = 40;              // bytes
    std::vector<std::uint32_t> masks = {};  // behind a header of 40, inside a longer one
    FileBytes palette = {}, pixels = {};
    std::uint32_t colors = 0;
    std::optional<std::uint32_t> offset = {};  // of the pixels, where the file lies about it

    FileBytes file() const {
        FileBytes info;
        info.little(header, 4);
        if (header == 12) {
            info.little(static_cast<std::uint32_t>(width), 2).little(static_cast<std::uint32_t>(height), 2);
            info.little(1, 2).little(static_cast<std::uint32_t>(bits), 2);
        } else {
            info.little(static_cast<std::uint32_t>(width), 4).little(static_cast<std::uint32_t>(height), 4);
            info.little(1, 2).little(static_cast<std::uint32_t>(bits), 2).little(compression, 4);
            info.little(0, 4).little(2835, 4).little(2835, 4).little(colors, 4).little(0, 4);
        }
        for (const std::uint32_t mask : masks) info.little(mask, 4);
        if (info.bytes.size() < header) info.zeros(header - info.bytes.size());
        if (header < 40) info.bytes.resize(header);
        info.put(palette);
        const auto place = static_cast<std::uint32_t>(14 + info.bytes.size());
        FileBytes all("BM");
        all.little(place + static_cast<std::uint32_t>(pixels.bytes.size()), 4).little(0, 4);
        return all.little(offset.value_or(place), 4).put(info).put(pixels);
    }
};

}  // namespace imgmesh
