// The colour space of an image from the statements in its file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "formats/picture/color/code_points.h"
#include "libcore/image/image.h"

namespace imgmesh {

/// What a file says about its colours. The first statement that imgmesh can use counts, in this order.
struct StatedColor {
    std::optional<CodePoints> code_points = {};         ///< of ITU-T H.273
    std::vector<std::uint8_t> icc = {};                 ///< a profile; empty for none
    std::string name = {};                              ///< of a colour space; empty for none
    std::optional<Chromaticities> chromaticities = {};  ///< none: Rec.709's
    float gamma = 0;                                    ///< linear = value^gamma; 0 if not stated
    bool inks = false;  ///< the first four channels are C, M, Y and K, where 1 is full ink
    std::optional<ColorSpace> fitting = {};  ///< ReadImageOptions::fitting_space
};

/// Sets the image's colour space. Samples of one of our spaces stay as they are; others are converted to the
/// space that holds them (docs/decisions/0027-colours-of-files.md), light above white to floats. Inks become
/// R, G and B, without a profile by (1 - C)(1 - K). If `asked` names a space, samples of light are taken for
/// that space and stay, and inks become it. Warnings name what cannot be used.
void settle_color(const StatedColor& stated, std::optional<ColorSpace> asked, Image& image,
                  std::vector<std::string>& warnings);

}  // namespace imgmesh
