// Profiles of Little CMS: our own colour spaces', those of files, and what they do to colours.
#pragma once

#include <lcms2.h>

#include <array>
#include <cstdint>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <string>

#include "libcore/image/image.h"

namespace imgmesh {

template <typename T, void (*close)(T*)>
struct LcmsCloser {
    void operator()(T* object) const { close(object); }
};
inline void close_lcms_profile(void* profile) {
    cmsCloseProfile(profile);
}
using LcmsProfile = std::unique_ptr<void, LcmsCloser<void, close_lcms_profile>>;
using LcmsTransform = std::unique_ptr<void, LcmsCloser<void, cmsDeleteTransform>>;
using LcmsCurve = std::unique_ptr<cmsToneCurve, LcmsCloser<cmsToneCurve, cmsFreeToneCurve>>;
using LcmsText = std::unique_ptr<cmsMLU, LcmsCloser<cmsMLU, cmsMLUfree>>;

/// For calls of ours, which fail only if memory is short.
template <typename Pointer>
Pointer made(Pointer object) {
    if (!object) throw std::bad_alloc();
    return object;
}

/// x and y of white, red, green and blue.
using Chromaticities = std::array<double, 8>;

/// Curves from encoded values to light: power g, or (a x + b)^g for x >= d and c x below.
LcmsCurve power_curve(double g);
LcmsCurve broken_curve(std::array<double, 5> gabcd);

/// Returns a matrix profile of that white, those primaries and one curve for all channels; nothing if they
/// span no colours.
LcmsProfile profile_from_primaries(const Chromaticities& xy, const cmsToneCurve& curve);
LcmsProfile profile_from_color_space(ColorSpace space);
/// Returns nothing for bytes that Little CMS cannot use as a profile, and for profiles of more than 16 MiB.
LcmsProfile profile_from_icc(std::span<const std::uint8_t> icc);

/// The profile's description on one line, at most 80 characters, in quotes; "without a name" if it has none.
std::string profile_name(const LcmsProfile& profile);

/// Returns the colour space that an RGB matrix profile or a grey profile stands for, within the tolerance by
/// which profiles differ; a grey one counts by its curve. Returns nothing for others. Removes the profile's
/// tables: the matrix counts.
std::optional<ColorSpace> color_space_of(const LcmsProfile& profile);

}  // namespace imgmesh
