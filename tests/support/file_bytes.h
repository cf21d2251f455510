// The bytes of a file, piece by piece.
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/picture/image_io.h"
#include "libcore/base/error.h"
#include "tests/support/temporary_folder.h"

namespace imgmesh {

struct FileBytes {
    std::vector<std::uint8_t> bytes;

    FileBytes() = default;
    explicit FileBytes(std::string_view text) : bytes(text.begin(), text.end()) {}

    /// A number of `count` bytes, the lowest first.
    FileBytes& little(std::uint32_t value, int count) {
        for (int i = 0; i < count; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
        return *this;
    }
    FileBytes& put(std::initializer_list<int> values) {
        for (const int value : values) bytes.push_back(static_cast<std::uint8_t>(value));
        return *this;
    }
    FileBytes& put(const FileBytes& more) {
        bytes.insert(bytes.end(), more.bytes.begin(), more.bytes.end());
        return *this;
    }
    FileBytes& zeros(std::size_t count) {
        bytes.resize(bytes.size() + count);
        return *this;
    }
    FileBytes without_last(std::size_t count) const {
        FileBytes shorter = *this;
        shorter.bytes.resize(bytes.size() - count);
        return shorter;
    }
};

/// Reads the bytes as a file of that name.
inline ReadImage read_bytes(const FileBytes& file, const std::string& name = "a",
                            const ReadImageOptions& options = {}) {
    const TemporaryFolder folder;
    save(folder / name, file.bytes);
    return read_image_file(folder / name, options);
}

/// The samples as codes of 8 bits, rounded.
inline std::vector<int> codes(const Image& image) {
    std::vector<int> out;
    for (const float sample : image.data) out.push_back(static_cast<int>(sample * 255 + 0.5f));
    return out;
}

/// What read_bytes() throws; nothing if it reads.
inline std::optional<Error> refusal(const FileBytes& file, const std::string& name = "a") {
    try {
        read_bytes(file, name);
    } catch (const Error& e) {
        return e;
    }
    return std::nullopt;
}

}  // namespace imgmesh
