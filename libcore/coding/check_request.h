// What may be asked of the encoder.
#pragma once

#include "libcore/coding/bitmap.h"
#include "libcore/coding/encode_picture.h"

namespace imgmesh::coding {

/// Throws Error(kBadArgument) for a picture without pixels, of another number of bytes than its size says or
/// larger than a stream can be, for parameters out of range, and unless exactly one says what to reach.
void check_request(const Bitmap& picture, const EncodeParams& params);

}  // namespace imgmesh::coding
