// Images for tests: made-up samples, and files written by OpenImageIO, not by us.
#pragma once

#include <OpenImageIO/imageio.h>
#include <doctest/doctest.h>
#include <optional>

#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "formats/picture/image_io.h"
#include "libcore/base/error.h"

/// Random codes of `levels` (255 or 65535), so that integer formats hold them exactly.
inline imgmesh::Image random_picture(int width, int height, int channels, int levels = 255,
                                     unsigned seed = 1) {
    imgmesh::Image image = imgmesh::make_image(width, height, channels);
    std::mt19937 random(seed);
    for (float& x : image.data)
        x = static_cast<float>(random() % (static_cast<unsigned>(levels) + 1)) / static_cast<float>(levels);
    return image;
}

inline float max_difference(const imgmesh::Image& a, const imgmesh::Image& b) {
    REQUIRE(a.width == b.width);
    REQUIRE(a.height == b.height);
    REQUIRE(a.channels == b.channels);
    float worst = 0;
    for (std::size_t i = 0; i < a.data.size(); ++i) worst = std::max(worst, std::abs(a.data[i] - b.data[i]));
    return worst;
}

/// Writes the samples as they are. `change` sets attributes.
inline void write_with_oiio(const std::string& path, const imgmesh::Image& image, OIIO::TypeDesc type,
                            const std::function<void(OIIO::ImageSpec&)>& change = {}) {
    OIIO::ImageSpec spec(image.width, image.height, image.channels, type);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    if (change) change(spec);
    const auto out = OIIO::ImageOutput::create(path);
    REQUIRE(out);
    REQUIRE(out->open(path, spec));
    REQUIRE(out->write_image(OIIO::TypeFloat, image.data.data()));
    REQUIRE(out->close());
}

/// Returns the kind of the Error that `call` throws, nothing if it throws none; its text goes to `text`.
inline std::optional<imgmesh::ErrorKind> error_of(const std::function<void()>& call,
                                                  std::string* text = nullptr) {
    try {
        call();
    } catch (const imgmesh::Error& e) {
        const std::string what = e.what();
        CHECK(what.find('\n') == std::string::npos);
        if (text) *text = what;
        return e.kind();
    }
    return std::nullopt;
}
