// The attributes of an EXR's header as metadata, and back. Internal to this room.
#pragma once

#include <OpenEXR/ImfHeader.h>

#include <string>
#include <vector>

#include "formats/exr/exr_metadata.h"

namespace imgmesh {

/// Returns what an image keeps of a header, within the limits of exr_metadata.h; a warning names what it does
/// not keep, except how pixels are stored. Without chromaticities if `with_primaries` is false.
ExrMetadata metadata_of(const Imf::Header& header, bool with_primaries, std::vector<std::string>& warnings);

/// Adds them to a header, except the windows.
void add_metadata(const ExrMetadata& metadata, Imf::Header& header);

/// The attribute as a window; it has the type box2i.
Imath::Box2i window_of(const ExrAttribute& attribute);

}  // namespace imgmesh
