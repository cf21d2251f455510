// imgmesh's uses of OpenImageIO, behind a table of functions in a shared module. The library loads 260
// others, which takes 0.17 s and 130 MB at the start of a program that may not need them
// (docs/decisions/0016-fast-files.md).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/picture/decode/picture_probe.h"
#include "formats/picture/image_io.h"
#include "formats/picture/image_text.h"

namespace imgmesh {

/// An image as its file stores it.
struct OiioPicture {
    int width = 0, height = 0, channels = 0;
    std::vector<std::string> channel_names;
    SampleType sample_type = SampleType::kUint8;
    std::vector<float> data;  ///< integers as code / maximum
    int orientation = 1;
    std::vector<std::uint8_t> icc;
    float gamma = 0;         ///< 0 for none
    std::string color_name;  ///< empty for none
};

/// An image as a file is to store it.
struct OiioTask {
    const char* writer;  ///< OpenImageIO's name
    std::string extension;
    int width, height;
    std::vector<std::string> channel_names;
    int alpha_channel;              ///< or -1
    SampleType type;                ///< kUint8, kUint16 or kFloat
    const void* samples;            ///< of that type
    bool say_srgb;                  ///< if the format has a word for it
    std::vector<std::uint8_t> icc;  ///< empty for none
};

struct OiioModule {
    /// Calls `check` with every size before memory is taken. Throws Error as decode_png() does.
    OiioPicture (*decode)(const std::string& path, std::span<const std::uint8_t> bytes,
                          const PictureClaim& claim, const ImageLimits& limits, decltype(&check_size) check);
    /// Throws Error: kBadArgument for what the format cannot hold, kUnsupported for a writer that does not
    /// exist.
    std::vector<std::uint8_t> (*encode)(const std::string& path, const OiioTask& task);
    /// draw_text().
    void (*draw_text)(Image& image, const TextLabel& label);
};

/// The only function that the module exports, by its name and type.
inline constexpr const char* kOiioEntry = "imgmesh_oiio_module";
using OiioEntry = const OiioModule*();

/// Returns the module, loaded on the first call and kept. Throws Error(kUnsupported) if it cannot be loaded.
const OiioModule& oiio_module();

}  // namespace imgmesh
