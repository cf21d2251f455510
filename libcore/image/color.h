// Converts colours between encoded samples, linear RGB (sRGB primaries, D65) and CIE 1976 L*u*v*.
#pragma once

#include <optional>
#include <string_view>

#include "libcore/base/types.h"
#include "libcore/image/image.h"
#include "libcore/image/mask.h"

namespace imgmesh {

/// Returns the name of a colour space in options, containers and reports, e.g. "sRGB".
std::string_view color_space_name(ColorSpace space);
/// The inverse of color_space_name(), ignoring case; nothing for an unknown name.
std::optional<ColorSpace> parse_color_space(std::string_view name);

/// Converts encoded RGB of `space` to linear RGB with sRGB primaries. Any finite values are allowed; the
/// curves are odd functions.
Vec3f linear_from_encoded(ColorSpace space, const Vec3f& encoded);
/// The inverse of linear_from_encoded().
Vec3f encoded_from_linear(ColorSpace space, const Vec3f& linear);
/// The same of a grey: white is white in every space, so only its curve matters.
float encoded_grey(ColorSpace space, float linear);

/// The matrix from XYZ under D65 (white has Y = 1) to linear RGB of the space's own primaries.
Eigen::Matrix3d rgb_from_xyz(ColorSpace space);
/// The matrix from linear RGB (sRGB primaries) to XYZ.
Eigen::Matrix3d xyz_from_linear();

/// Converts linear RGB (sRGB primaries, white = 1,1,1) to L*u*v* under D65. Defined and continuous for every
/// finite input: below black L* follows its linear branch, and chroma is zero where X + 15 Y + 3 Z <= 0.
Vec3f luv_from_linear(const Vec3f& linear);
/// The inverse of luv_from_linear() for L* > 0. For L* <= 0 the chroma is dropped.
Vec3f linear_from_luv(const Vec3f& luv);

/// The linear RGB values that a colour may have.
enum class Gamut {
    kDisplay,  ///< [0, 1]
    kHdr       ///< 0 and more: high dynamic range
};

/// Returns `luv` itself if its linear RGB lies in the gamut, else a colour of the gamut that is close to it
/// in L*u*v*. (Clamping the RGB channels moves a colour several times as far: near black a small step in
/// L*u*v* leaves the gamut by a lot.)
Vec3f in_gamut(const Vec3f& luv, Gamut gamut = Gamut::kDisplay);

/// Returns the colour, again L*u*v*, that a container keeps of in_gamut(luv): its linear RGB is rounded to
/// 16-bit codes, or as quantized_hdr() does for HDR.
/// quantized_color(quantized_color(x)) == quantized_color(x), bit for bit.
Vec3f quantized_color(const Vec3f& luv, Gamut gamut = Gamut::kDisplay);
/// Returns the 16-bit codes (65535 is 1) of the linear RGB of in_gamut(luv), and converts codes to L*u*v*.
/// The codes of a quantised colour give the same colour back, bit for bit.
std::array<std::uint16_t, 3> color_codes(const Vec3f& luv);
Vec3f color_from_codes(const std::array<std::uint16_t, 3>& codes);

/// The largest linear value of a colour in Gamut::kHdr. Quadrics are single precision; the squares of its L*
/// fit.
inline constexpr float kMaxHdr = 1 << 20;

/// Returns the linear RGB of in_gamut(luv, kHdr), rounded to 16 bits of the largest of the three, at least to
/// 2^-20. This is fine enough for any eye, and converting to L*u*v* and back gives the same bits.
Vec3f quantized_hdr(const Vec3f& luv);

/// Returns kHdr for a float image with a linear value above 1 in some pixel of the mask, else kDisplay.
Gamut gamut_of(const Image& image, const Mask& mask = {});

/// How luv_image() treats linear RGB: leave it, clip it to [0, 1], or clip it to [0, kMaxHdr].
enum class Range { kAny, kClipped, kHdr };

/// Returns the colour of every pixel as L*u*v*, within 1e-4 of luv_from_linear(). One channel (grey) counts
/// as R = G = B; alpha is ignored. The result is the same for any number of threads. Throws
/// Error(kUnsupported) if the image has neither R, G, B nor Y.
FeatureImage luv_image(const Image& image, Range range = Range::kAny);

}  // namespace imgmesh
