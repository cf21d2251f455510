// Memory that imgmesh and its program of codecs both see.
#pragma once

#include <cstdint>
#include <span>

#include "formats/picture/codecs/file_descriptor.h"

namespace imgmesh {

class SharedMemory {
  public:
    SharedMemory() = default;
    /// New memory, all zero, whose size nobody can change, so that no access to it can fail later. Throws
    /// Error(kIo) if the system refuses it, std::bad_alloc if there is no room for it.
    explicit SharedMemory(std::uint64_t size);
    /// Memory that came from elsewhere. Throws Error(kInternal) if it has not that size or might shrink.
    SharedMemory(FileDescriptor file, std::uint64_t size);
    SharedMemory(SharedMemory&& other) noexcept;
    SharedMemory& operator=(SharedMemory&& other) noexcept;
    ~SharedMemory();

    std::span<std::uint8_t> bytes() const { return {start_, size_}; }
    int file() const { return file_.get(); }

  private:
    void map();

    FileDescriptor file_;
    std::uint8_t* start_ = nullptr;
    std::size_t size_ = 0;
};

}  // namespace imgmesh
