// Containers that are changed after they were written, and how a reader refuses them.
#pragma once

#include <doctest/doctest.h>

#include <cstdint>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "formats/container/container.h"
#include "formats/files/atomic_file.h"
#include "libcore/base/error.h"
#include "tests/support/random_mesh_image.h"
#include "tests/support/temporary_folder.h"

namespace imgmesh::test {

using nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

inline Bytes read_bytes(const std::string& path) {
    return read_file(path, 1 << 24);
}

inline void write_bytes(const std::string& path, std::span<const std::uint8_t> bytes) {
    std::ofstream out(path, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

inline void write_text(const std::string& path, const std::string& text) {
    write_bytes(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

/// Returns the code in the message of the Error, or "" if there is none. A message must be one line that
/// names the file.
inline std::string refusal(const std::string& path, const ContainerLimits& limits = {}) {
    try {
        read_container(path, limits);
        return "";
    } catch (const Error& error) {
        const std::string text = error.what();
        CHECK(text.starts_with(path + ": ["));
        CHECK(text.find('\n') == std::string::npos);
        CHECK((error.kind() == ErrorKind::kBadFile || error.kind() == ErrorKind::kUnsupported));
        const auto begin = text.find('[') + 1;
        return text.substr(begin, text.find(']') - begin);
    }
}

/// A .gltf whose JSON can be changed.
struct Broken {
    TemporaryFolder folder;
    std::string path = folder / "x.gltf";

    explicit Broken(DracoMode mode = DracoMode::kOff) {
        write_container(path, random_mesh_image(20, 15, 2, WeightPrecision::kHalf, true, 5), {mode, true});
    }
    std::string with(const auto& change) {
        return with(change, [] {});
    }
    /// `look`s at the changed file.
    std::string with(const auto& change, const auto& look) {
        const Bytes good = read_bytes(path);
        json document = json::parse(good.begin(), good.end());
        change(document);
        write_text(path, document.dump());
        const std::string code = refusal(path);
        look();
        write_bytes(path, good);
        return code;
    }
};

}  // namespace imgmesh::test
