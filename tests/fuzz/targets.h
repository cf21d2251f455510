// What is fed with hostile bytes. Each returns whether the input was accepted, and throws for anything but
// the Errors that its reader documents.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tests/fuzz/mutate.h"

namespace imgmesh::fuzz {

enum class Target { kContainer, kPicture, kEdits };

/// `bytes` through the reader; containers through the validator too, which must agree with it.
bool feed(Target target, std::span<const std::uint8_t> bytes);

/// Good inputs to start from.
std::vector<Bytes> seeds(Target target);

}  // namespace imgmesh::fuzz
