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

// Rows in luminance and chroma, counted from the top of the data window. Those with an even number have
// chroma at every pixel, the others none. They are read as they are asked for, and the latest kept.
class ChromaRows {
  public:
    ChromaRows(Imf::InputPart& part, const ExrChoice& choice, int first)
        : part_(part),
          window_(part.header().dataWindow()),
          padded_(static_cast<std::size_t>(width() + kTaps - 1), Imf::Rgba(0, 0, 0)),
          next_(first) {
        Imf::FrameBuffer buffer;
        const auto insert = [&](const std::string& name, Imath::half& sample, int sampling) {
            constexpr auto kStride = static_cast<std::ptrdiff_t>(sizeof(Imf::Rgba));
            // Windows of subsampled images start at even pixels.
            buffer.insert(
                name,
                Imf::Slice(Imf::HALF, reinterpret_cast<char*>(&sample) - kStride * window_.min.x,
                           sizeof(Imf::Rgba) * static_cast<std::size_t>(sampling), 0, sampling, sampling));
        };
        insert(choice.luma, padded_[kSide].g, 1);
        insert(choice.red_chroma, padded_[kSide].r, 2);
        insert(choice.blue_chroma, padded_[kSide].b, 2);
        part_.setFrameBuffer(buffer);
        for (Row& row : rows_) row.resize(static_cast<std::size_t>(width()));
    }

    int width() const { return window_.max.x - window_.min.x + 1; }

    // Row y, at most kHeld above the lowest that was asked for.
    const Row& row(int y) {
        for (; next_ <= y; ++next_) read(next_);
        return rows_[place(y)];
    }

  private:
    static constexpr std::size_t kHeld = kTaps;
    static std::size_t place(int y) { return static_cast<std::size_t>(y) % kHeld; }

    void read(int y) {
        part_.readPixels(window_.min.y + y);
        Row& row = rows_[place(y)];
        if (y % 2 != 0) {
            std::copy_n(padded_.begin() + kSide, width(), row.begin());
            return;
        }
        // The outermost samples go on beyond the edges. The last one is at an even pixel.
        std::fill_n(padded_.begin(), kSide, padded_[kSide]);
        const auto last = static_cast<std::size_t>(kSide) + static_cast<std::size_t>((width() - 1) / 2) * 2;
        for (std::size_t i = last + 1; i < padded_.size(); ++i) {
            padded_[i].r = padded_[last].r;
            padded_[i].b = padded_[last].b;
        }
        Imf::RgbaYca::reconstructChromaHoriz(width(), padded_.data(), row.data());
    }

    Imf::InputPart& part_;
    const Imath::Box2i window_;
    Row padded_;
    std::array<Row, kHeld> rows_;
    int next_;
};

}  // namespace

void check_exr_chroma(const std::string& path, const Imf::ChannelList& channels, const ExrChoice& choice) {
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

void read_exr_chroma(Imf::InputPart& part, const ExrChoice& choice, int first, int last,
                     const std::function<void(int, const float*)>& take) {
    const Imf::Header& header = part.header();
    const Imath::V3f weights = Imf::RgbaYca::computeYw(
        Imf::hasChromaticities(header) ? Imf::chromaticities(header) : Imf::Chromaticities());
    const Imath::Box2i window = header.dataWindow();
    const int top = first - window.min.y, bottom = last - window.min.y;
    const int height = window.max.y - window.min.y + 1, last_even = (height - 1) / 2 * 2;
    ChromaRows rows(part, choice, std::max(0, top - 1 - kSide));
    const int width = rows.width();

    // Also of the rows -1 and `height`, as OpenEXR has them.
    const auto to_rgb = [&](int y, Row& out) {
        const Row& own = rows.row(y < 0 ? 0 : y >= height ? last_even : y);
        const Imf::Rgba* in = own.data();
        if (y % 2 != 0) {
            std::array<const Imf::Rgba*, kTaps> taps{};
            // Chroma counts at even rows, which have even places here, and luminance in the middle.
            for (int i = 0; i < kTaps; i += 2)
                taps[static_cast<std::size_t>(i)] = rows.row(std::clamp(y - kSide + i, 0, last_even)).data();
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
    to_rgb(top - 1, rgb[0]);
    to_rgb(top, rgb[1]);
    for (int y = top; y <= bottom; ++y) {
        to_rgb(y + 1, rgb[2]);
        const std::array<const Imf::Rgba*, 3> around = {rgb[0].data(), rgb[1].data(), rgb[2].data()};
        Imf::RgbaYca::fixSaturation(weights, width, around.data(), sound.data());
        for (std::size_t x = 0; x < sound.size(); ++x) {
            out[3 * x] = sound[x].r;
            out[3 * x + 1] = sound[x].g;
            out[3 * x + 2] = sound[x].b;
        }
        take(window.min.y + y, out.data());
        std::swap(rgb[0], rgb[1]);
        std::swap(rgb[1], rgb[2]);
    }
}

}  // namespace imgmesh
