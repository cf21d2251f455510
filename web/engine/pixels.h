// Images as a canvas has them: 8-bit RGBA, not premultiplied.
#pragma once

#include <emscripten/val.h>

#include <vector>

#include "libcore/image/image.h"

namespace imgmesh::web {

using emscripten::val;

/// Returns an image of 8-bit sRGB from { width, height, data }, data having 4 values a pixel as ImageData has
/// them. It is R, G and B if every pixel is opaque, else R, G, B and A. Throws Error(kBadArgument) where the
/// sizes disagree.
Image image_from_pixels(const val& pixels);

/// Returns { width, height, data } of an image in sRGB, of channels as draw() has them, with data a
/// Uint8ClampedArray.
val pixels_from_image(const Image& image);

/// Returns a copy of `values` as a typed array of JavaScript.
template <typename T>
val typed_array(const std::vector<T>& values, const char* type) {
    const val view(emscripten::typed_memory_view(values.size(), values.data()));
    return val::global(type).new_(view);
}

/// Returns the bytes of any typed array or ArrayBuffer view of bytes.
std::vector<std::uint8_t> bytes_from(const val& array);

}  // namespace imgmesh::web
