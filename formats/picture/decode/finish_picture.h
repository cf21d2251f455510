// What all pictures need after a decoder has given their samples. Internal to this room.
#pragma once

#include "formats/picture/decode/picture_decoders.h"

namespace imgmesh {

/// Chooses channels, divides associated alpha out, checks or replaces samples that are not finite, settles
/// the colour space or makes values, and turns the picture as a viewer shows it. Throws as read_image_file()
/// does.
ReadImage finish_picture(const std::string& path, DecodedPicture picture, const ReadImageOptions& options);

}  // namespace imgmesh
