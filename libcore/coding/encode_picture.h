// A picture as a coded mesh: as good as a number of bytes allows, or as small as an error allows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "libcore/base/progress.h"
#include "libcore/coding/bitmap.h"

namespace imgmesh {

/// The error that an encoder keeps low.
enum class Tune {
    kPsnr,  ///< squared error over all channels alike
    kLuma,  ///< mostly that of luma (Rec. 601)
    kSsim   ///< as kLuma, and more where luma varies little around a pixel, as in SSIM
};

/// The largest of each, and what people want who say nothing else: 1 vertex for 108 pixels, with which a
/// photograph takes about 0.16 bits a pixel.
inline constexpr double kMostPsnr = 100, kMostQuality = 100, kUsualQuality = 50;
inline constexpr int kMostEffort = 5;

/// What to reach. Exactly one of the first four is set.
struct EncodeParams {
    std::optional<std::size_t> bytes;     ///< at most so many bytes
    std::optional<double> psnr;           ///< over all channels [dB], of colours times alpha
    std::optional<std::size_t> vertices;  ///< so many vertices, at least 4
    std::optional<double> quality;        ///< 0 to 100: vertices per pixel, from 1/8192 doubling every 8

    int effort = 3;  ///< 1 to 5; each takes up to four times as long as the one before
    Tune tune = Tune::kPsnr;
};

struct EncodeReport {
    std::size_t vertices = 0, faces = 0;
    double grid_step = 0;  ///< [pixels]
    double psnr = 0;       ///< of the decoder's picture, over all channels [dB]; infinity if they are equal
    std::size_t header_bytes = 0, point_bytes = 0, face_bytes = 0, color_bytes = 0;
    bool reached = true;  ///< false if the wanted PSNR or number of vertices could not be had
};

struct EncodedPicture {
    std::vector<std::uint8_t> bytes;
    EncodeReport report;
};

/// Encodes a picture of at most 2^26 pixels and 65535 a side. Takes about 5 s for 768 x 512 pixels with
/// effort 3 and 100 bytes of memory a pixel, 140 with kSsim. The same picture and parameters give the same
/// bytes on every machine.
///
/// Throws Error(kBadArgument) for a picture without pixels, parameters out of range, and a number of bytes
/// that is below what the four corners take; the message says how many that is. Source:
/// docs/decisions/0045-coded-pictures.md.
EncodedPicture encode_picture(const Bitmap& picture, const EncodeParams& params,
                              const Progress& progress = {});

}  // namespace imgmesh
