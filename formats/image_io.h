// Pictures from and to files, through OpenImageIO (and OpenEXR's own checks for EXR). Target
// imgmesh_pictures.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "libcore/image/image.h"

namespace imgmesh {

/// What read_image refuses before it takes memory.
struct ImageLimits {
    std::int64_t max_pixels = std::int64_t{1} << 28;  ///< 268 megapixels
    int max_side = 65535;
    int max_channels = 64;
};

/// Reads the first subimage of any format that OpenImageIO knows, at full resolution, all channels.
///
/// 8 and 16 bit integers are scaled to [0, 1], half and float kept; 1-bit, palette and CMYK become RGB(A);
/// associated alpha is divided out; EXIF orientation is applied (width and height as a viewer shows them).
/// Channel names are R G B A Y where that is what they are. The colour space is `color_space`, else what the
/// file says, else sRGB for integers and linear for floats. Pixels outside an EXR's data window are 0.
///
/// Throws Error: kIo where the file cannot be read; kBadFile for content that is no picture, broken or
/// truncated, over the limits, or with samples that are not finite; kUnsupported for what OpenImageIO reads
/// but imgmesh does not (deep, volume). Never aborts, whatever the bytes.
Image read_image(const std::string& path, std::optional<ColorSpace> color_space = {},
                 const ImageLimits& limits = {});

struct WriteImageOptions {
    bool overwrite = true;
    std::optional<SampleType> sample_type;  ///< none: the image's, or the nearest that the format can hold
};

/// Writes in the format of the extension, atomically; integers are rounded and clamped; EXR is written linear
/// (colour is converted), other formats as encoded, with the colour space noted where the format can. Throws
/// Error: kUsage for an extension that cannot be written, kIo otherwise.
void write_image(const std::string& path, const Image& image, const WriteImageOptions& options = {});

/// Whether write_image knows this path's extension.
bool can_write_image(const std::string& path);

}  // namespace imgmesh
