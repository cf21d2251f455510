// What is fed with hostile bytes: one target for each decoder, and for the other readers.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tests/fuzz/mutate.h"

namespace imgmesh::fuzz {

/// kGif to kHeif are the formats of imgmesh-codecs, decoded in this process. kProfile is an ICC profile
/// alone, kConfig a file for --config, kCompact a container's compact
/// stream by itself, kCoded a coded picture.
enum class Target {
    kContainer,
    kPng,
    kJpeg,
    kTiff,
    kExr,
    kWebp,
    kBmp,
    kTga,
    kPnm,
    kGif,
    kHdr,
    kJp2,
    kHeif,
    kProfile,
    kEdits,
    kConfig,
    kCompact,
    kCoded
};
inline constexpr Target kLastTarget = Target::kCoded;

/// container, png, and so on.
const char* name_of(Target target);
std::optional<Target> target_of(std::string_view name);

/// Passes `bytes` through the reader; containers through the validator too, which must agree with it. Returns
/// whether they were accepted. Throws for anything but the Errors that the reader documents. An image of
/// another format than the target's counts as refused.
bool feed(Target target, std::span<const std::uint8_t> bytes);

/// Good inputs to start from.
std::vector<Bytes> seeds(Target target);

/// Changes an input in the way that suits the target.
Bytes mutated(Target target, const Bytes& bytes, Mutator& mutator);

}  // namespace imgmesh::fuzz
