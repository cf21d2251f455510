// Which part, layer and channels of an EXR become the image. Internal to this folder.
#pragma once

#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPixelType.h>

#include <string>
#include <vector>

#include "formats/picture/image_io.h"

namespace imgmesh {

struct ExrChannel {
    std::string name;  ///< in the image
    std::string full;  ///< in the file; empty for R, G and B that luminance and chroma make
    Imf::PixelType type = Imf::HALF;
    bool required = true;  ///< false: it is left out if it cannot be read
};

struct ExrChoice {
    int part = 0;
    std::string layer;                 ///< empty for channels without a prefix
    bool chosen = false;               ///< the file left a choice
    std::vector<ExrChannel> channels;  ///< colour first, then alpha, then the others
    std::string luma, red_chroma,
        blue_chroma;  ///< the file's names; empty unless R, G and B are made of them
    std::vector<std::string> warnings;
};

/// Returns what `options` say, else the first part with colour, and in it the unnamed layer, else the first
/// with R, G and B, else with Y, RY and BY, else with Y. Named channels are looked for in the layer, then in
/// the part; if neither part nor layer is given, in the first part that has them all.
///
/// Throws Error: kBadFile for a part, layer or channel that the file does not have (the text lists those that
/// it has), kUnsupported for deep parts, subsampled channels, and a file without colour if nothing is named.
ExrChoice choose_exr(const std::string& path, const Imf::MultiPartInputFile& file,
                     const ReadImageOptions& options);

/// The part's name, or its number.
std::string exr_part_name(const Imf::MultiPartInputFile& file, int part);

}  // namespace imgmesh
