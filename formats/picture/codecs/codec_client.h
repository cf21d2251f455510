// What imgmesh lets its program of codecs do. Reading is decode_with_codecs() of picture_decoders.h.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formats/picture/codecs/codec_types.h"

namespace imgmesh {

/// Returns the bytes of the file. `samples` are those of the task's size and type. Throws Error: kBadArgument
/// for what the format cannot hold, kUnsupported for a writer that does not exist, kInternal if the library
/// crashes.
std::vector<std::uint8_t> encode_with_codecs(const EncodeTask& task, std::span<const std::uint8_t> samples);

}  // namespace imgmesh
