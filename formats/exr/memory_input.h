// A stream of OpenEXR over bytes in memory.
#pragma once

#include <ImfIO.h>

#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>

namespace imgmesh {

/// The bytes must outlive it. Reading beyond them throws, as OpenEXR expects; seeking does not.
class MemoryInput : public Imf::IStream {
  public:
    MemoryInput(const char* name, std::span<const std::uint8_t> bytes) : IStream(name), bytes_(bytes) {}

    bool read(char* out, int count) override {
        const auto wanted = static_cast<std::size_t>(count);
        if (count < 0 || at_ > bytes_.size() || wanted > bytes_.size() - at_)
            throw std::runtime_error("the file ends too early");
        std::memcpy(out, bytes_.data() + at_, wanted);
        at_ += wanted;
        return at_ < bytes_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t at) override { at_ = at; }

  private:
    std::span<const std::uint8_t> bytes_;
    std::uint64_t at_ = 0;
};

}  // namespace imgmesh
