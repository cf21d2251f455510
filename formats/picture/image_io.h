// Images from and to files: PNG, JPEG, TIFF, EXR and WebP by themselves, the rest through
// OpenImageIO, which is loaded when it is first needed. Target imgmesh::pictures.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "formats/exr/exr_metadata.h"
#include "libcore/image/image.h"
#include "libcore/image/mask.h"

namespace imgmesh {

/// read_image() refuses larger images before it takes memory for them.
struct ImageLimits {
    std::int64_t max_pixels = std::int64_t{1} << 28;  ///< 268 megapixels
    int max_side = 65535;
    int max_channels = 64;
    /// Of the samples, as stored and as floats, and of what the caller does with the image [bytes].
    std::uint64_t max_memory = std::numeric_limits<std::uint64_t>::max();
    double work_bytes = 0;  ///< what the caller's work takes for each pixel beside 8 for each channel; >= 0
    /// Of images above 4 megapixels; 0: any number. Ten times what deflate makes of one grey, so that only
    /// files made to ask for too much, or empty pages, are refused.
    std::int64_t max_pixels_per_byte = 10000;
};

/// What becomes of samples that are infinite or no number.
enum class NonFinite {
    kRefuse,   ///< Error(kBadFile)
    kZero,     ///< 0
    kNearest,  ///< the channel's value at the nearest pixel where it is finite, else as kRefuse
};

/// How read_image() reads.
struct ReadImageOptions {
    std::optional<ColorSpace> color_space = {};  ///< none: what the file says
    ImageLimits limits = {};
    /// Of an EXR: a part's name, or its number from 0; none: the first part with colour.
    std::optional<std::string> part = {};
    /// Of an EXR: all before the last dot of its channels' names, which the image's names lack; none: the
    /// unnamed layer if it has colour, else the first that has.
    std::optional<std::string> layer = {};
    /// Channels that must be there, by their names in the layer or else in the part; alpha is read with them.
    /// Empty: the colour and alpha. None: all channels; those beside colour and alpha that cannot be read are
    /// left out, with a warning.
    std::optional<std::vector<std::string>> channels = {};
    NonFinite non_finite = NonFinite::kRefuse;
    /// The samples are data, not colours: integers keep their own numbers (of 8 bits 0 to 255), palettes
    /// their indices, nothing is converted, alpha is not divided out. The image is linear floats. R, G, B or
    /// Y are named by value_name(), so that they are no colour; alpha stays A, from 0 to 1.
    bool values = false;
    /// Pixels are no data where all channels but A have this value, in the file's own numbers; may be NaN.
    std::optional<double> nodata = {};
    bool file_nodata = true;  ///< without `nodata`, the value that the file names (GDAL's tag in TIFF)
    /// Where integers go that a profile gives in none of our spaces; none: to the narrowest that holds them.
    std::optional<ColorSpace> fitting_space = {};
};

/// Where the image of an EXR was found.
struct ImagePlace {
    std::string part;   ///< its name, or else its number
    std::string layer;  ///< empty for channels without a prefix
};

/// An image, and what a person should know of how it was read.
struct ReadImage {
    Image image;
    std::vector<std::string> warnings;  ///< each one sentence without the file's name
    std::optional<ImagePlace> place;    ///< of an EXR that left a choice
    std::int64_t non_finite = 0;        ///< samples that ReadImageOptions::non_finite replaced
    ExrMetadata metadata = {};          ///< of an EXR
    Mask data = {};  ///< the pixels with data; empty() if all have some. The samples of others mean nothing
};

/// Reads the first image (frame, layer, part with colour) of a PNG, JPEG, TIFF, EXR, WebP, GIF, BMP, PNM,
/// TGA, Radiance HDR, JPEG 2000 or HEIF file at full resolution, all channels. The content decides, not the
/// name.
///
/// 8 and 16 bit integers are scaled to [0, 1], half and float kept; 1-bit, palette, CMYK and YCbCr become
/// grey or RGB(A); associated alpha is divided out; EXIF orientation is applied (width and height as a viewer
/// shows them). Channel names are R G B A Y where that is what they are. The colour space is that of
/// the options, else one that holds the colours that the file states by profile, primaries or code points, to
/// which they are converted unless they are in one of ours (docs/images.md), else sRGB for integers and
/// linear for floats. An EXR's image is its display window; pixels outside the data window are 0. Luminance
/// and chroma become RGB, and integers of an EXR are numbers.
///
/// Throws Error: kIo if the file cannot be read; kBadFile for content that is no image, broken or
/// truncated, over the limits, with samples that are not finite, or without the part, layer or channel asked
/// for; kUnsupported for what imgmesh has no use for (deep EXR, subsampled channels other than chroma, EXR
/// integers of 2^24 and more, camera raw, CIELAB, signed integers). Never aborts, whatever the bytes.
ReadImage read_image_file(const std::string& path, const ReadImageOptions& options = {});
/// The image of read_image_file() alone, for callers who need no warnings.
Image read_image(const std::string& path, const ReadImageOptions& options = {});

/// How write_image() writes.
struct WriteImageOptions {
    bool overwrite = true;                  ///< false: Error(kIo) if the file exists
    std::optional<SampleType> sample_type;  ///< none: the image's, or the nearest that the format can hold
    ExrMetadata metadata = {};              ///< for an EXR's header
};

/// Writes in the format of the extension, atomically; integers are rounded and clamped. PNG (8 and 16 bit),
/// JPEG, TIFF (8, 16, float), WebP (lossless), EXR (half, float), BMP, PPM and PNM (8 bit).
///
/// The colours read back are those of `image`: floats are written linear (EXR's with associated alpha), and
/// linear floats become sRGB in integers; other integers stay as encoded, noted by an ICC profile in colour
/// PNG, JPEG and TIFF, and become sRGB in the rest, which can note none. Floats without a colour become
/// a TIFF's bands; where alpha is 0 they are NaN, which the TIFF names as nodata. The same image gives the
/// same bytes.
///
/// An EXR gets the attributes of `metadata`. If its display window is of the image's size, that is the
/// image's, and pixels outside the data window are left out; RGB is written in the primaries of
/// chromaticities.
///
/// Throws Error: kBadArgument for an extension that cannot be written, and for what its format cannot hold:
/// the sample type asked for, channels other than grey or colour, transparency (an opaque alpha is left out),
/// WebP's and JPEG's size; kIo if the file cannot be written.
void write_image(const std::string& path, const Image& image, const WriteImageOptions& options = {});

/// The bytes that write_image() would write into a file of that name; only the extension counts. Throws as
/// write_image() does.
std::vector<std::uint8_t> encode_image(const std::string& path, const Image& image,
                                       std::optional<SampleType> sample_type = {},
                                       const ExrMetadata& metadata = {});

/// Whether write_image() can write a file of this extension.
bool can_write_image(const std::string& path);

}  // namespace imgmesh
