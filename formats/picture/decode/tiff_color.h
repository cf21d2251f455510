// From the samples of a TIFF to channels as images have them.
#pragma once

#include <vector>

#include "formats/picture/decode/picture_decoders.h"
#include "formats/picture/decode/tiff_layout.h"

namespace imgmesh {

/// Makes the image of `samples` (interleaved, own numbers, as the layout has them): integers divided by their
/// largest code, inverted grey turned, palettes looked up, YCbCr, L*a*b* and LogLuv as RGB, inks as C, M, Y,
/// K. Extra samples become A or "channelN", N counted from 0. Sets the image without its colour space,
/// associated_alpha, color.inks, and warnings. Throws Error(kBadFile) for a palette that is not there.
void image_from_samples(const TiffFile& file, const TiffLayout& layout, std::vector<float> samples,
                        DecodedPicture& out);

/// The same for values: all samples keep their own numbers, whatever they would mean as colours. Only alpha
/// is divided by its largest code.
void values_from_samples(const TiffLayout& layout, std::vector<float> samples, DecodedPicture& out);

/// Returns the names that those samples get.
std::vector<std::string> sample_names(const TiffLayout& layout);

}  // namespace imgmesh
