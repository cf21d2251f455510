#include "formats/compact/band_coder.h"

#include <algorithm>
#include <cstring>

#include "formats/exr/zip_blocks.h"
#include "libcore/base/index.h"

namespace imgmesh {
namespace {

// The median predictor of JPEG-LS (Weinberger, Seroussi and Sapiro 2000, eq. 1). `d` begins above and to the
// left of the band.
int predict(std::span<const std::int16_t> d, std::size_t i, std::size_t width) {
    const std::size_t x = i % width;
    if (i < width) return x > 0 ? d[i - 1] : 0;
    if (x == 0) return d[i - width];
    const int w = d[i - 1], n = d[i - width], nw = d[i - width - 1];
    return std::clamp(w + n - nw, std::min(w, n), std::max(w, n));
}

}  // namespace

std::vector<std::uint8_t> encode_band(const Band& band) {
    const std::size_t width = as_index(band.width), pixels = width * as_index(band.rows);
    std::vector<std::int16_t> residuals;
    residuals.reserve(2 * pixels);
    for (const std::span<const std::int16_t> d : {band.dx, band.dy})
        for (std::size_t i = 0; i < pixels; ++i)
            residuals.push_back(static_cast<std::int16_t>(d[i] - predict(d, i, width)));
    ZipPacker packer;
    return packer.pack({reinterpret_cast<const std::uint8_t*>(residuals.data()), 4 * pixels});
}

bool decode_band(std::span<const std::uint8_t> bytes, const MutableBand& band) {
    const std::size_t width = as_index(band.width), pixels = width * as_index(band.rows);
    std::vector<std::uint8_t> residuals(4 * pixels);
    ZipUnpacker unpacker;
    if (!unpacker.unpack(bytes, residuals)) return false;
    const std::uint8_t* in = residuals.data();
    for (const std::span<std::int16_t> d : {band.dx, band.dy})
        for (std::size_t i = 0; i < pixels; ++i) {
            std::int16_t residual;
            std::memcpy(&residual, in, sizeof residual);
            in += sizeof residual;
            d[i] = static_cast<std::int16_t>(predict(d, i, width) + residual);
        }
    return true;
}

}  // namespace imgmesh
