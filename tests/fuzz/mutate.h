// Random changes to files that keep enough of their structure for a reader to come to the part that was
// changed.
#pragma once

#include <algorithm>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <random>
#include <string>
#include <vector>

namespace imgmesh::fuzz {

using Bytes = std::vector<std::uint8_t>;

/// The same changes for the same seed.
class Mutator {
  public:
    explicit Mutator(std::uint32_t seed) : random_(seed) {}

    /// A .glb: a value of its JSON, bytes of its Draco meshes, of its EXR's header or pixels, or bytes
    /// anywhere.
    Bytes glb(const Bytes& file);
    /// A PNG: chunks, what is compressed in them, and their order; with right checksums.
    Bytes png(const Bytes& file);
    /// Any file: bits, bytes, numbers, lengths, with the head of the file more often than the rest.
    Bytes any(const Bytes& file);
    /// JSON text: values, names, or characters.
    std::string json_text(const std::string& text);

    std::uint32_t below(std::size_t count) {
        return static_cast<std::uint32_t>(random_() % std::max<std::size_t>(count, 1));
    }

  private:
    void change_value(nlohmann::json& document);
    void change_bytes(Bytes& bytes, std::size_t begin, std::size_t length);

    std::mt19937 random_;
};

}  // namespace imgmesh::fuzz
