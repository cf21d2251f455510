// Sources: ITU-T H.273 (07/2024), tables 2 and 3; SMPTE ST 2084 and ITU-R BT.2100-2, tables 4 and 5, for PQ
// and HLG; ITU-R BT.2408-7 for white.
#include "formats/picture/color/code_points.h"

#include <algorithm>
#include <cmath>

#include "libcore/base/parallel.h"

namespace imgmesh {
namespace {

constexpr double kWhiteNits = 203;

std::optional<Chromaticities> primaries_of(int code) {
    switch (code) {
        case 1:  // BT.709, sRGB
        case 2:
            return Chromaticities{0.3127, 0.3290, 0.64, 0.33, 0.30, 0.60, 0.15, 0.06};
        case 4:  // BT.470 System M
            return Chromaticities{0.310, 0.316, 0.67, 0.33, 0.21, 0.71, 0.14, 0.08};
        case 5:  // BT.470 System B, G; BT.601 of 625 lines
            return Chromaticities{0.3127, 0.3290, 0.64, 0.33, 0.29, 0.60, 0.15, 0.06};
        case 6:  // BT.601 of 525 lines
        case 7:  // SMPTE ST 240
            return Chromaticities{0.3127, 0.3290, 0.630, 0.340, 0.310, 0.595, 0.155, 0.070};
        case 8:  // generic film
            return Chromaticities{0.310, 0.316, 0.681, 0.319, 0.243, 0.692, 0.145, 0.049};
        case 9:  // BT.2020, BT.2100
            return Chromaticities{0.3127, 0.3290, 0.708, 0.292, 0.170, 0.797, 0.131, 0.046};
        case 11:  // DCI P3, with the white of cinemas
            return Chromaticities{0.314, 0.351, 0.680, 0.320, 0.265, 0.690, 0.150, 0.060};
        case 12:  // Display P3
            return Chromaticities{0.3127, 0.3290, 0.680, 0.320, 0.265, 0.690, 0.150, 0.060};
        case 22:  // EBU Tech. 3213
            return Chromaticities{0.3127, 0.3290, 0.630, 0.340, 0.295, 0.605, 0.155, 0.077};
        default:
            return std::nullopt;
    }
}

LcmsCurve curve_of(int transfer) {
    switch (transfer) {
        case 1:  // BT.709, BT.601, BT.2020 (with both precisions); with negative light, xvYCC and BT.1361
        case 6:
        case 11:
        case 12:
        case 14:
        case 15:
            return broken_curve({1 / 0.45, 1 / 1.099, 0.099 / 1.099, 1 / 4.5, 0.081});
        case 2:
        case 13:  // sRGB
            return broken_curve({2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045});
        case 4:
            return power_curve(2.2);
        case 5:
            return power_curve(2.8);
        case 7:  // SMPTE ST 240
            return broken_curve({1 / 0.45, 1 / 1.1115, 0.1115 / 1.1115, 1 / 4.0, 0.0912});
        case 8:
        case 16:
        case 18:
            return power_curve(1);
        case 17:  // SMPTE ST 428: 48 of 52.37 cd/m2 are white
            return broken_curve({2.6, std::pow(52.37 / 48, 1 / 2.6), 0, 0, 0});
        default:
            return nullptr;
    }
}

double pq_nits(double code) {
    constexpr double kM1 = 2610.0 / 16384, kM2 = 2523.0 / 4096 * 128, kC1 = 3424.0 / 4096,
                     kC2 = 2413.0 / 4096 * 32, kC3 = 2392.0 / 4096 * 32;
    const double power = std::pow(std::max(code, 0.0), 1 / kM2);
    return 10000 * std::pow(std::max(power - kC1, 0.0) / (kC2 - kC3 * power), 1 / kM1);
}

// Light of the scene in [0, 1].
double hlg_scene(double code) {
    constexpr double kA = 0.17883277, kB = 1 - 4 * kA;
    const double c = 0.5 - kA * std::log(4 * kA);
    const double x = std::max(code, 0.0);
    return x <= 0.5 ? x * x / 3 : (std::exp((x - c) / kA) + kB) / 12;
}

// BT.2100 has the weights of BT.2020, the only primaries that HLG is specified for.
void show_hlg(float& r, float& g, float& b) {
    constexpr double kPeakNits = 1000, kSystemGamma = 1.2;
    const double scene[3] = {hlg_scene(double(r)), hlg_scene(double(g)), hlg_scene(double(b))};
    const double luminance = 0.2627 * scene[0] + 0.6780 * scene[1] + 0.0593 * scene[2];
    const double gain = kPeakNits / kWhiteNits * std::pow(luminance, kSystemGamma - 1);
    r = static_cast<float>(gain * scene[0]);
    g = static_cast<float>(gain * scene[1]);
    b = static_cast<float>(gain * scene[2]);
}

}  // namespace

bool is_hdr(const CodePoints& codes) {
    return codes.transfer == 16 || codes.transfer == 18;
}

LcmsProfile profile_from_code_points(const CodePoints& codes) {
    const std::optional<Chromaticities> primaries = primaries_of(codes.primaries);
    const LcmsCurve curve = curve_of(codes.transfer);
    return primaries && curve ? profile_from_primaries(*primaries, *curve) : nullptr;
}

void decode_hdr(const CodePoints& codes, Image& image) {
    constexpr int kGrainRows = 16;
    int r = image.channel("R"), g = image.channel("G"), b = image.channel("B");
    const int grey = image.channel("Y");
    if (std::min({r, g, b}) < 0) r = g = b = grey;
    if (r < 0) return;
    parallel_blocks(0, image.height, kGrainRows, [&](int first, int last) {
        for (int y = first; y < last; ++y)
            for (int x = 0; x < image.width; ++x) {
                float* const p = image.pixel(x, y);
                float red = p[r], green = p[g], blue = p[b];
                if (codes.transfer == 18)
                    show_hlg(red, green, blue);
                else
                    for (float* v : {&red, &green, &blue})
                        *v = static_cast<float>(pq_nits(double(*v)) / kWhiteNits);
                p[r] = red;
                p[g] = green;
                p[b] = blue;
            }
    });
}

}  // namespace imgmesh
