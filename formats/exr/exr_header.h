// Checks an EXR's headers before OpenEXR reads them.
#pragma once

#include <cstdint>
#include <span>

namespace imgmesh {

/// Refuses headers that would make OpenEXR take memory or run code that a container never needs: attributes
/// longer than 64 kB or than the file; attributes of other types than strings, the channel list and a few of
/// fixed size (a preview, an id manifest or a string vector has inner sizes of its own); deep data; more than
/// `max_parts` parts. Throws FindingError.
void check_exr_header(std::span<const std::uint8_t> bytes, int max_parts);

}  // namespace imgmesh
