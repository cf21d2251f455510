// What the program of codecs can do. All of it runs in a process of its own for each job.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "formats/picture/codecs/codec_types.h"

namespace imgmesh {

/// Asks imgmesh for the memory of an image's samples, once the image's size and all that CodecPicture says
/// are known and before any is decoded. Returns room for exactly those samples, all zero. Does not return if
/// imgmesh refuses the size.
using OfferPicture = std::function<std::span<std::uint8_t>(const CodecPicture&)>;

/// Each decodes the file's `bytes` into the memory that `offer` gives. Throws Error: kBadFile for broken or
/// truncated content and sizes over the limits, kUnsupported for kinds of images that imgmesh does not use.
void decode_by_oiio(const DecodeTask& task, std::span<const std::uint8_t> bytes, const OfferPicture& offer);
/// HEIC and AVIF, of 8 bits, or as 16 bits of more. The library has decoded the image when `offer` is called:
/// only then its size is certain. It takes no memory for more pixels than the file claims.
void decode_by_libheif(const DecodeTask& task, std::span<const std::uint8_t> bytes,
                       const OfferPicture& offer);

/// Returns the bytes of the file. Throws Error as encode_with_codecs() says.
std::vector<std::uint8_t> encode_by_oiio(const EncodeTask& task, std::span<const std::uint8_t> samples);

/// Draws into `samples`, floats. Throws Error(kUnsupported) if the font is not installed.
void draw_by_oiio(const TextTask& task, std::span<std::uint8_t> samples);

/// To be called once, before the first job: OpenImageIO loads no plugins and starts no threads.
void prepare_oiio();

}  // namespace imgmesh
