// Images as values. Said once, for all of imgmesh: pixel (0, 0) is the *centre* of the top-left pixel, x
// grows to the right and y grows *down*; an image of W x H pixels spans [0, W-1] x [0, H-1].
#pragma once

#include <string>
#include <vector>

#include "libcore/base/grid.h"

namespace imgmesh {

/// The pixels left <= x < right, top <= y < bottom.
struct PixelRect {
    int left, top, right, bottom;

    int width() const { return right - left; }
    int height() const { return bottom - top; }
};

/// How the file of an image stored its samples, so that results can be stored alike.
enum class SampleType { kUint8, kUint16, kHalf, kFloat };

/// The meaning of the numbers of a colour image: primaries and transfer curve.
enum class ColorSpace {
    kSrgb,      ///< "sRGB": IEC 61966-2-1, the default for integer images
    kLinear,    ///< "linear": sRGB/Rec.709 primaries, linear light; the default for half and float images
    kRec709,    ///< "Rec709": Rec.709 primaries and its camera transfer curve
    kGamma22,   ///< "Gamma2.2": sRGB primaries, pure power 2.2
    kAdobeRgb,  ///< "AdobeRGB": Adobe RGB (1998), power 563/256
    kDisplayP3  ///< "DisplayP3": P3 primaries, D65, sRGB curve
};

/// An image: `channels` interleaved floats a pixel. Integer samples are scaled to [0, 1]; values are as
/// encoded in `color_space`, not linearised. Alpha is not premultiplied.
struct Image : ChannelGrid {
    std::vector<std::string>
        channel_names;  ///< size channels: "R","G","B" / "Y" / with "A"; or a file's own names
    SampleType sample_type = SampleType::kUint8;
    ColorSpace color_space = ColorSpace::kSrgb;

    /// Index of the named channel, or -1.
    int channel(const std::string& name) const;
};

/// Returns an all-zero image of that shape. With 1, 2, 3 or 4 channels they are named Y / Y A / R G B / R G B
/// A, otherwise C0, C1, ...
Image make_image(int width, int height, int channels);

/// An image in feature space: `channels` floats per pixel; for colour L*, u*, v* (L* in 0..100). Errors are
/// measured in this space.
struct FeatureImage : ChannelGrid {
    using ChannelGrid::ChannelGrid;
};

}  // namespace imgmesh
