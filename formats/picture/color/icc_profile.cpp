// Source of the header's layout: ICC.1:2010 (4.3), section 7.2.
#include "formats/picture/color/icc_profile.h"

#include <algorithm>
#include <array>
#include <string>

#include "formats/picture/color/lcms_profile.h"
#include "libcore/image/color.h"

namespace imgmesh {

std::optional<ColorSpace> color_space_from_icc(std::span<const std::uint8_t> bytes) {
    const LcmsProfile profile = profile_from_icc(bytes);
    return profile ? color_space_of(profile) : std::nullopt;
}

std::vector<std::uint8_t> icc_from_color_space(ColorSpace space) {
    const LcmsProfile profile = profile_from_color_space(space);
    cmsSetProfileVersion(profile.get(), 4.3);
    const LcmsText name = made(LcmsText(cmsMLUalloc(nullptr, 1)));
    cmsUInt32Number size = 0;
    if (!cmsMLUsetASCII(name.get(), "en", "US", std::string(color_space_name(space)).c_str()) ||
        !cmsWriteTag(profile.get(), cmsSigProfileDescriptionTag, name.get()) ||
        !cmsSaveProfileToMem(profile.get(), nullptr, &size))
        throw std::bad_alloc();
    std::vector<std::uint8_t> bytes(size);
    if (!cmsSaveProfileToMem(profile.get(), bytes.data(), &size)) throw std::bad_alloc();
    // Little CMS writes the time. The same image must give the same file, so it is noon, 1 January 2000.
    constexpr std::size_t kDateOffset = 24;
    constexpr std::array<std::uint8_t, 12> kDate = {2000 >> 8, 2000 & 0xFF, 0, 1, 0, 1, 0, 12, 0, 0, 0, 0};
    std::ranges::copy(kDate, bytes.begin() + kDateOffset);
    return bytes;
}

}  // namespace imgmesh
