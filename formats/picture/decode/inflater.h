// Deflate that is undone piece by piece. Internal to this room.
#pragma once

#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace imgmesh {

/// A stream of zlib. Throws std::bad_alloc where zlib has no memory.
class Inflater {
  public:
    /// Whether the stream has zlib's own header and checksum, and zlib looks at them.
    enum class Frame { kRaw, kZlib };
    enum class State { kGoesOn, kEnded, kBroken };
    struct Step {
        std::size_t count;  ///< bytes that were written
        State state;
    };

    explicit Inflater(Frame frame);
    ~Inflater();
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;

    /// Begins another stream. What was given is forgotten.
    void restart();
    /// Gives the next packed bytes, once those before are used up. They must outlive their use.
    void give(std::span<std::uint8_t> packed);
    bool is_used_up() const { return z_.avail_in == 0; }
    /// Takes one of the given bytes as it is.
    std::uint8_t take();
    /// Undoes what was given, into the beginning of `out`.
    Step unpack(std::span<std::uint8_t> out);

  private:
    z_stream z_ = {};
};

}  // namespace imgmesh
