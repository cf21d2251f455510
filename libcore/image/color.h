// Colour: encoded samples <-> linear light (sRGB primaries, D65) <-> CIE 1976 L*u*v*.
#pragma once

#include <optional>
#include <string_view>

#include "libcore/base/types.h"
#include "libcore/image/image.h"
#include "libcore/image/mask.h"

namespace imgmesh {

/// The name by which options, containers and reports call a colour space, e.g. "sRGB".
std::string_view color_space_name(ColorSpace space);
/// The inverse of color_space_name (case is ignored); nothing for an unknown name.
std::optional<ColorSpace> parse_color_space(std::string_view name);

/// Encoded RGB of `space` -> linear light with sRGB primaries. Any finite values; the curves are odd
/// functions.
Vec3f linear_from_encoded(ColorSpace space, const Vec3f& encoded);
/// The inverse of linear_from_encoded.
Vec3f encoded_from_linear(ColorSpace space, const Vec3f& linear);

/// XYZ under D65 (white has Y = 1) -> linear RGB of the space's own primaries.
Eigen::Matrix3d rgb_from_xyz(ColorSpace space);

/// Linear RGB (sRGB primaries, white = 1,1,1) -> L*u*v* under D65. Defined and continuous for every finite
/// input: L* follows its linear branch below black, and chroma is zero where X + 15 Y + 3 Z <= 0.
Vec3f luv_from_linear(const Vec3f& linear);
/// The inverse of luv_from_linear for L* > 0; black for L* <= 0 chroma-free.
Vec3f linear_from_luv(const Vec3f& luv);

/// Which linear RGB a colour may have.
enum class Gamut {
    kDisplay,  ///< [0, 1]
    kHdr       ///< 0 and more: high dynamic range
};

/// `luv` itself where its linear RGB lies in the gamut, else a colour close to it, in L*u*v*, for which that
/// holds. (Clamping the RGB channels goes several times as far: near black a small step in L*u*v* leaves the
/// gamut by a lot.)
Vec3f in_gamut(const Vec3f& luv, Gamut gamut = Gamut::kDisplay);

/// What a container keeps of `luv`: in_gamut(luv) as linear RGB rounded, for displays to 16-bit codes, for
/// light to quantized_hdr(). quantized_color(quantized_color(x)) == quantized_color(x), bit for bit.
Vec3f quantized_color(const Vec3f& luv, Gamut gamut = Gamut::kDisplay);
/// Linear RGB of a quantized colour as its 16-bit codes, and back.
std::array<std::uint16_t, 3> color_codes(const Vec3f& luv);
Vec3f color_from_codes(const std::array<std::uint16_t, 3>& codes);

/// The most light that a colour of Gamut::kHdr has. Quadrics are single precision: the squares of its L*
/// have room.
inline constexpr float kMaxHdr = 1 << 20;

/// in_gamut(luv, kHdr) as linear RGB, rounded to 16 bits of the largest of the three and at least to 2^-20:
/// fine enough for any eye, and coarse enough for quantized_color() to come back to the same bits.
Vec3f quantized_hdr(const Vec3f& luv);

/// kHdr for an image of floats with linear light above 1 in some pixel of the mask, else kDisplay.
Gamut gamut_of(const Image& image, const Mask& mask = {});

/// What luv_image does with linear light: nothing, or clip it to [0, 1] or to [0, kMaxHdr].
enum class Range { kAny, kClipped, kHdr };

/// Colour of every pixel as L*u*v*. One channel (grey) counts as R = G = B; alpha is ignored.
/// Throws Error(kUnsupported) where the image has neither R, G, B nor Y.
FeatureImage luv_image(const Image& image, Range range = Range::kAny);

}  // namespace imgmesh
