#include "formats/picture/decode/exr_chroma.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfRgba.h>
#include <OpenEXR/ImfRgbaYca.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include <algorithm>
#include <array>

#include "formats/files/one_line.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

// OpenEXR's filters take 27 samples, of which 13 are on either side.
constexpr int kTaps = Imf::RgbaYca::N, kSide = Imf::RgbaYca::N2;
using Row = std::vector<Imf::Rgba>;

void check_sampling(const std::string& path, const Imf::ChannelList& channels, const ExrChoice& choice) {
    const auto check = [&](const std::string& name, int sampling) {
        const Imf::Channel& channel = channels[name.c_str()];
        if (channel.xSampling != sampling || channel.ySampling != sampling)
            throw Error(ErrorKind::kUnsupported,
                        cat(path, ": channel ", printable(name), " is subsampled ", channel.xSampling, " x ",
                            channel.ySampling, ", expected ", sampling, " x ", sampling));
    };
    check(choice.luma, 1);
    check(choice.red_chroma, 2);
    check(choice.blue_chroma, 2);
}

// Rows in luminance and chroma. Those with an even y have chroma at every pixel, the others none.
std::vector<Row> read_rows(Imf::InputPart& part, const ExrChoice& choice) {
    const Imath::Box2i window = part.header().dataWindow();
    const int width = window.max.x - window.min.x + 1;
    Row padded(static_cast<std::size_t>(width + kTaps - 1), Imf::Rgba(0, 0, 0));
    Imf::FrameBuffer buffer;
    const auto insert = [&](const std::string& name, Imath::half& first, int sampling) {
        constexpr auto kStride = static_cast<std::ptrdiff_t>(sizeof(Imf::Rgba));
        // Windows of subsampled images start at even pixels.
        buffer.insert(
            name, Imf::Slice(Imf::HALF, reinterpret_cast<char*>(&first) - kStride * window.min.x,
                             sizeof(Imf::Rgba) * static_cast<std::size_t>(sampling), 0, sampling, sampling));
    };
    insert(choice.luma, padded[kSide].g, 1);
    insert(choice.red_chroma, padded[kSide].r, 2);
    insert(choice.blue_chroma, padded[kSide].b, 2);
    part.setFrameBuffer(buffer);
    std::vector<Row> rows;
    for (int y = window.min.y; y <= window.max.y; ++y) {
        part.readPixels(y);
        Row& row = rows.emplace_back(static_cast<std::size_t>(width));
        if (y % 2 != 0) {
            std::copy_n(padded.begin() + kSide, width, row.begin());
            continue;
        }
        // The outermost samples go on beyond the edges. The last one is at an even pixel.
        std::fill_n(padded.begin(), kSide, padded[kSide]);
        const auto last = static_cast<std::size_t>(kSide) + static_cast<std::size_t>((width - 1) / 2) * 2;
        for (std::size_t i = last + 1; i < padded.size(); ++i) {
            padded[i].r = padded[last].r;
            padded[i].b = padded[last].b;
        }
        Imf::RgbaYca::reconstructChromaHoriz(width, padded.data(), row.data());
    }
    return rows;
}

}  // namespace

void read_exr_chroma(const std::string& path, Imf::InputPart& part, const ExrChoice& choice,
                     const std::function<void(int, const float*)>& take) {
    const Imf::Header& header = part.header();
    check_sampling(path, header.channels(), choice);
    const Imath::V3f weights = Imf::RgbaYca::computeYw(
        Imf::hasChromaticities(header) ? Imf::chromaticities(header) : Imf::Chromaticities());
    std::vector<Row> rows = read_rows(part, choice);
    const int height = static_cast<int>(rows.size()), last_even = (height - 1) / 2 * 2;
    const int width = static_cast<int>(rows[0].size());

    // Also of the rows -1 and `height`, as OpenEXR has them.
    const auto to_rgb = [&](int y, Row& out) {
        const Row& own = rows[static_cast<std::size_t>(y < 0 ? 0 : y >= height ? last_even : y)];
        const Imf::Rgba* in = own.data();
        if (y % 2 != 0) {
            std::array<const Imf::Rgba*, kTaps> taps{};
            for (int i = 0; i < kTaps; ++i) {
                const int from = y - kSide + i;  // even for the taps that count
                taps[static_cast<std::size_t>(i)] =
                    rows[static_cast<std::size_t>(std::clamp(from, 0, last_even))].data();
            }
            taps[kSide] = own.data();
            Imf::RgbaYca::reconstructChromaVert(width, taps.data(), out.data());
            in = out.data();
        }
        Imf::RgbaYca::YCAtoRGBA(weights, width, in, out.data());
    };
    std::array<Row, 3> rgb;
    for (Row& row : rgb) row.resize(static_cast<std::size_t>(width));
    Row sound(static_cast<std::size_t>(width));
    std::vector<float> out(3 * sound.size());
    to_rgb(-1, rgb[0]);
    to_rgb(0, rgb[1]);
    for (int y = 0; y < height; ++y) {
        to_rgb(y + 1, rgb[2]);
        const std::array<const Imf::Rgba*, 3> around = {rgb[0].data(), rgb[1].data(), rgb[2].data()};
        Imf::RgbaYca::fixSaturation(weights, width, around.data(), sound.data());
        for (std::size_t x = 0; x < sound.size(); ++x) {
            out[3 * x] = sound[x].r;
            out[3 * x + 1] = sound[x].g;
            out[3 * x + 2] = sound[x].b;
        }
        take(header.dataWindow().min.y + y, out.data());
        std::swap(rgb[0], rgb[1]);
        std::swap(rgb[1], rgb[2]);
    }
}

}  // namespace imgmesh
