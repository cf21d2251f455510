// What is fed with hostile bytes. Each returns whether the input was accepted, and throws for anything but
// the Errors that its reader documents.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tests/fuzz/mutate.h"

namespace imgmesh::fuzz {

/// kSmall: the images that no library reads for imgmesh, BMP, TGA and Netpbm.
enum class Target { kContainer, kPicture, kSmall, kEdits };

/// container, picture, small or edits.
const char* name_of(Target target);

/// `bytes` through the reader; containers through the validator too, which must agree with it.
bool feed(Target target, std::span<const std::uint8_t> bytes);

/// Good inputs to start from.
std::vector<Bytes> seeds(Target target);

}  // namespace imgmesh::fuzz
