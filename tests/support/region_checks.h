// Compares what a RegionSource gives with the whole picture.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <random>
#include <string>
#include <utility>

#include "formats/picture/region_source.h"
#include "libcore/base/error.h"

namespace imgmesh {

/// Returns the error of reading a region, which must be that of a bad file, or "".
inline std::string failure(const RegionSource& source, const PixelRect& region) {
    try {
        (void)source.read(region);
    } catch (const Error& error) {
        CHECK(error.kind() == ErrorKind::kBadFile);
        return error.what();
    }
    return "";
}

/// Checks that `part` is what `whole` has in `region`, to the bit.
inline void check_part(const ReadImage& part, const ReadImage& whole, const PixelRect& region) {
    REQUIRE(part.image.width == region.width());
    REQUIRE(part.image.height == region.height());
    REQUIRE(part.image.channel_names == whole.image.channel_names);
    CHECK(part.image.sample_type == whole.image.sample_type);
    CHECK(part.image.color_space == whole.image.color_space);
    int wrong = 0;
    for (int y = region.top; y < region.bottom; ++y)
        for (int x = region.left; x < region.right; ++x) {
            const int at_x = x - region.left, at_y = y - region.top;
            wrong += std::memcmp(part.image.pixel(at_x, at_y), whole.image.pixel(x, y),
                                 sizeof(float) * static_cast<std::size_t>(whole.image.channels)) != 0;
            wrong += (part.data.empty() || part.data.at(at_x, at_y) != 0) !=
                     (whole.data.empty() || whole.data.at(x, y) != 0);
        }
    CHECK(wrong == 0);
}

/// Reads all of `path` by pieces of `step` x `step` pixels, and all at once.
inline void check_regions(const std::string& path, int step, const ReadImageOptions& options = {}) {
    const ReadImage whole = read_image_file(path, options);
    const RegionSource source(path, options);
    REQUIRE(source.facts().width == whole.image.width);
    REQUIRE(source.facts().height == whole.image.height);
    CHECK(source.facts().channel_names == whole.image.channel_names);
    CHECK(source.facts().sample_type == whole.image.sample_type);
    CHECK(source.color_space() == whole.image.color_space);
    const int width = whole.image.width, height = whole.image.height;
    for (int y = 0; y < height; y += step)
        for (int x = 0; x < width; x += step) {
            const PixelRect region{x, y, std::min(x + step, width), std::min(y + step, height)};
            INFO("region at ", x, ", ", y);
            check_part(source.read_region(region), whole, region);
        }
    const PixelRect all{0, 0, width, height};
    check_part(source.read_region(all), whole, all);
}

/// Checks that parts of `copy` are what read_image() gives of `path`, with the same options.
inline void check_copy(const std::string& path, const std::string& copy, int step,
                       const ReadImageOptions& options = {}) {
    const ReadImage whole = read_image_file(path, options);
    const RegionSource of_path(path, options), source(copy, options);
    CHECK(source.facts().access == RegionAccess::kDirect);
    REQUIRE(source.facts().width == whole.image.width);
    REQUIRE(source.facts().height == whole.image.height);
    REQUIRE(of_path.facts().width == whole.image.width);
    CHECK(of_path.facts().channel_names == whole.image.channel_names);
    CHECK(of_path.facts().sample_type == whole.image.sample_type);
    CHECK(source.color_space() == whole.image.color_space);
    CHECK(of_path.color_space() == whole.image.color_space);
    for (int y = 0; y < whole.image.height; y += step)
        for (int x = 0; x < whole.image.width; x += step) {
            const PixelRect region{x, y, std::min(x + step, whole.image.width),
                                   std::min(y + step, whole.image.height)};
            check_part(source.read_region(region), whole, region);
        }
}

/// Reads so many rectangles at random, of the size of a few pixels to all.
inline void check_random_regions(const std::string& path, int count, const ReadImageOptions& options = {}) {
    const ReadImage whole = read_image_file(path, options);
    const RegionSource source(path, options);
    REQUIRE(source.facts().width == whole.image.width);
    REQUIRE(source.facts().height == whole.image.height);
    std::mt19937 random(5);
    const auto span = [&](int size) {
        const auto a = static_cast<int>(random() % static_cast<unsigned>(size)),
                   b = static_cast<int>(random() % static_cast<unsigned>(size));
        return std::pair(std::min(a, b), std::max(a, b) + 1);
    };
    for (int i = 0; i < count; ++i) {
        const std::pair x = span(whole.image.width), y = span(whole.image.height);
        const PixelRect region{x.first, y.first, x.second, y.second};
        INFO("columns ", region.left, " to ", region.right, ", rows ", region.top, " to ", region.bottom);
        check_part(source.read_region(region), whole, region);
    }
}

}  // namespace imgmesh
