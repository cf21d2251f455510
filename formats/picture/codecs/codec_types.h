// What imgmesh asks its program of codecs to do, and what it gets, as values and as bytes.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/picture/codecs/wire.h"
#include "formats/picture/color/stated_color.h"
#include "formats/picture/decode/picture_probe.h"
#include "formats/picture/image_io.h"
#include "formats/picture/image_text.h"

namespace imgmesh {

struct DecodeTask {
    std::string path;  ///< for messages; the program opens no file
    PictureClaim claim;
    ImageLimits limits;
};

/// An image as its file stores it, without its samples: those are codes of 8 or 16 bits, or floats for both
/// kHalf and kFloat, channels together, rows from the top.
struct CodecPicture {
    std::int64_t width = 0, height = 0, channels = 0;
    SampleType sample_type = SampleType::kUint8;
    std::vector<std::string> channel_names;
    bool associated_alpha = false;
    int orientation = 1;
    StatedColor color;
    std::vector<std::string> warnings;
};

/// An image as a file is to store it. Its samples are codes, or floats for kFloat.
struct EncodeTask {
    std::string path;    ///< for messages
    std::string writer;  ///< OpenImageIO's name
    std::string extension;
    int width = 0, height = 0;
    std::vector<std::string> channel_names;
    int alpha_channel = -1;  ///< or -1
    SampleType type = SampleType::kUint8;
    bool say_srgb = false;          ///< if the format has a word for it
    std::vector<std::uint8_t> icc;  ///< empty for none
};

/// Labels to be drawn over an image of floats.
struct TextTask {
    int width = 0, height = 0, channels = 0;
    std::vector<TextLabel> labels;
};

/// Bytes of one sample as the two sides exchange it.
constexpr std::uint64_t bytes_of_sample(SampleType type) {
    return type == SampleType::kUint8 ? 1 : type == SampleType::kUint16 ? 2 : 4;
}

/// Where the data begin behind a header of that size: samples of any type are aligned there.
constexpr std::uint64_t data_offset(std::uint64_t header_bytes) {
    return (header_bytes + 63) / 64 * 64;
}

std::vector<std::uint8_t> wire_from(const DecodeTask& task);
std::vector<std::uint8_t> wire_from(const EncodeTask& task);
std::vector<std::uint8_t> wire_from(const TextTask& task);
/// All but the size and the type of its samples, which are in the offer (wire.h).
std::vector<std::uint8_t> wire_from(const CodecPicture& picture);

/// Each throws std::runtime_error for bytes that are no such value.
DecodeTask decode_task_from(std::span<const std::uint8_t> wire);
EncodeTask encode_task_from(std::span<const std::uint8_t> wire);
TextTask text_task_from(std::span<const std::uint8_t> wire);
CodecPicture codec_picture_from(std::span<const std::uint8_t> wire);

}  // namespace imgmesh
