// JPEG files of every kind, by libjpeg.
#pragma once

#include <cstdio>
// It needs stdio.h before it.
#include <jpeglib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "libcore/image/image.h"

namespace imgmesh {

struct JpegKind {
    int channels = 3;
    int horizontal = 2, vertical = 2;  ///< sampling of the first channel
    bool progressive = false, arithmetic = false;
    int restart = 0;  ///< rows of blocks
    J_COLOR_SPACE ink = JCS_YCCK;
    bool adobe = true;
};

/// The image as a JPEG of that kind, by libjpeg itself.
inline std::vector<std::uint8_t> encoded(const Image& image, const JpegKind& kind) {
    jpeg_compress_struct jpeg = {};
    jpeg_error_mgr errors = {};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    unsigned char* out = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&jpeg, &out, &size);
    jpeg.image_width = static_cast<JDIMENSION>(image.width);
    jpeg.image_height = static_cast<JDIMENSION>(image.height);
    jpeg.input_components = image.channels;
    jpeg.in_color_space = kind.channels == 1 ? JCS_GRAYSCALE : kind.channels == 3 ? JCS_RGB : JCS_CMYK;
    jpeg_set_defaults(&jpeg);
    if (kind.channels == 4) jpeg_set_colorspace(&jpeg, kind.ink);
    if (kind.channels == 4) jpeg.write_Adobe_marker = kind.adobe;
    jpeg.comp_info[0].h_samp_factor = kind.horizontal;
    jpeg.comp_info[0].v_samp_factor = kind.vertical;
    if (kind.progressive) jpeg_simple_progression(&jpeg);
    jpeg.arith_code = kind.arithmetic;
    jpeg.restart_in_rows = kind.restart;
    jpeg_start_compress(&jpeg, TRUE);
    std::vector<JSAMPLE> row(static_cast<std::size_t>(image.width * image.channels));
    for (int y = 0; y < image.height; ++y) {
        std::ranges::transform(image.row(y), row.begin(),
                               [](float v) { return static_cast<JSAMPLE>(std::lround(255 * v)); });
        JSAMPROW at = row.data();
        jpeg_write_scanlines(&jpeg, &at, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    std::vector<std::uint8_t> bytes(out, out + size);
    std::free(out);
    return bytes;
}

}  // namespace imgmesh
