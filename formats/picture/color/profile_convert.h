// Converts samples by a profile to light, and light to the colour space that holds it.
#pragma once

#include <optional>

#include "formats/picture/color/lcms_profile.h"
#include "libcore/image/image.h"

namespace imgmesh {

/// The image in ColorSpace::kLinear, by relative colorimetric intent without black point compensation, white
/// being white. Grey stays grey. Of `inks` (the first four channels are C, M, Y and K, 1 is full ink) the
/// result has R, G and B in their place. Other channels stay. Nothing is clipped unless the profile's tables
/// end at [0, 1]. Nothing is returned if the profile is for other channels, if Little CMS cannot use it, and
/// if colours that it gives are not finite.
std::optional<Image> linear_from_profile(const Image& image, const LcmsProfile& profile, bool inks);

/// How many pixels lie outside of the [0, 1] of spaces, by more than 0.01 of linear light.
struct OutsideGamut {
    std::int64_t srgb = 0, display_p3 = 0, adobe_rgb = 0;
};
/// Counts those of an image in ColorSpace::kLinear, and adds them.
void count_outside(const Image& image, OutsideGamut& counts);
/// Returns the space that encode_in_narrowest() chooses for an image with such counts.
ColorSpace narrowest_space(const OutsideGamut& counts);

/// Converts ColorSpace::kLinear to sRGB if no pixel lies outside of its [0, 1] by more than 0.01 of linear
/// light, else to that of Display P3 and Adobe RGB (1998) which fewer pixels lie outside of, Display P3 if
/// both are alike. Values outside are kept.
void encode_in_narrowest(Image& image);

/// Converts ColorSpace::kLinear to `space`.
void encode_in(Image& image, ColorSpace space);

}  // namespace imgmesh
