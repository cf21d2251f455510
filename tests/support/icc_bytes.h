// Profiles that Little CMS makes, as files have them.
#pragma once

#include <doctest/doctest.h>
#include <lcms2.h>

#include <cstdint>
#include <vector>

namespace imgmesh::test {

// Returns the bytes of the profile, and frees it.
inline std::vector<std::uint8_t> saved(cmsHPROFILE profile, double version = 4.3) {
    cmsSetProfileVersion(profile, version);
    cmsUInt32Number size = 0;
    REQUIRE(cmsSaveProfileToMem(profile, nullptr, &size));
    std::vector<std::uint8_t> bytes(size);
    REQUIRE(cmsSaveProfileToMem(profile, bytes.data(), &size));
    cmsCloseProfile(profile);
    return bytes;
}

}  // namespace imgmesh::test
