// A stream of OpenEXR into memory: files are written by AtomicFile alone.
#pragma once

#include <ImfIO.h>

#include <cstdint>
#include <cstring>
#include <vector>

namespace imgmesh {

class MemoryOutput : public Imf::OStream {
  public:
    MemoryOutput() : OStream("memory") {}
    void write(const char* in, int count) override {
        const auto n = static_cast<std::size_t>(count);
        if (at_ + n > bytes.size()) bytes.resize(at_ + n);
        std::memcpy(bytes.data() + at_, in, n);
        at_ += n;
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t at) override { at_ = at; }
    std::vector<std::uint8_t> bytes;

  private:
    std::uint64_t at_ = 0;
};

}  // namespace imgmesh
