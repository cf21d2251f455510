// The mask and the visits of a band, deflated. Internal to this room.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "libcore/base/types.h"

namespace imgmesh {

/// Appends the flags of rows: a bit for each pixel, each row as its difference from the one above.
void put_mask(std::vector<std::uint8_t>& out, std::span<const std::uint8_t> inside, int width);
/// Appends the visits of rows, 4 bytes each.
void put_visits(std::vector<std::uint8_t>& out, std::span<const Id> visits);

/// Take the same from the front of `bytes`. Return false if they are not there. Safe for any bytes.
/// take_visits with empty `visits` only steps over `pixels` of them.
bool take_mask(std::span<const std::uint8_t>& bytes, std::span<std::uint8_t> inside, int width);
bool take_visits(std::span<const std::uint8_t>& bytes, std::span<Id> visits);

}  // namespace imgmesh
