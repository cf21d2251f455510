// Sources: IEC 61966-2-1 (sRGB), ITU-R BT.709, Adobe RGB (1998), SMPTE EG 432-1 (P3); CIE 15 for L*u*v*.
#include "libcore/image/color.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <utility>

#include "libcore/base/error.h"
#include "libcore/base/parallel.h"
#include "libcore/base/parallel_vector.h"
#include "libcore/image/cie.h"
#include "libcore/image/luv_decoder.h"

namespace imgmesh {
namespace {

// Rows of one block: enough work to be worth handing over, few enough for every thread to get some.
constexpr int kGrainRows = 16;

constexpr std::pair<ColorSpace, std::string_view> kNames[] = {
    {ColorSpace::kSrgb, "sRGB"},         {ColorSpace::kLinear, "linear"},
    {ColorSpace::kRec709, "Rec709"},     {ColorSpace::kGamma22, "Gamma2.2"},
    {ColorSpace::kAdobeRgb, "AdobeRGB"}, {ColorSpace::kDisplayP3, "DisplayP3"}};

// Both curves are applied to |x| and keep the sign, so values below black survive a round trip.
double decode_curve(ColorSpace space, double x) {
    switch (space) {
        case ColorSpace::kLinear:
            return x;
        case ColorSpace::kSrgb:
        case ColorSpace::kDisplayP3:
            return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
        case ColorSpace::kRec709:
            return x < 0.081 ? x / 4.5 : std::pow((x + 0.099) / 1.099, 1 / 0.45);
        case ColorSpace::kGamma22:
            return std::pow(x, 2.2);
        case ColorSpace::kAdobeRgb:
            return std::pow(x, 563.0 / 256.0);
    }
    return x;
}

double encode_curve(ColorSpace space, double x) {
    switch (space) {
        case ColorSpace::kLinear:
            return x;
        case ColorSpace::kSrgb:
        case ColorSpace::kDisplayP3:
            return x <= 0.0031308 ? x * 12.92 : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
        case ColorSpace::kRec709:
            return x < 0.018 ? x * 4.5 : 1.099 * std::pow(x, 0.45) - 0.099;
        case ColorSpace::kGamma22:
            return std::pow(x, 1 / 2.2);
        case ColorSpace::kAdobeRgb:
            return std::pow(x, 256.0 / 563.0);
    }
    return x;
}

using Matrix = Eigen::Matrix3d;

// Eigen sums three products in another order where it has vector instructions than where it has none. These
// sum from left to right, so that colours are the same on any machine, WebAssembly's too.
Vec3d times(const Matrix& m, const Vec3d& v) {
    Vec3d out;
    for (int r = 0; r < 3; ++r) out[r] = m(r, 0) * v[0] + m(r, 1) * v[1] + m(r, 2) * v[2];
    return out;
}
Matrix times(const Matrix& a, const Matrix& b) {
    Matrix out;
    for (int c = 0; c < 3; ++c) out.col(c) = times(a, Vec3d(b.col(c)));
    return out;
}
// By the transposed cofactors.
Matrix inverse(const Matrix& m) {
    Matrix adjoint;
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) {
            const int i = (c + 1) % 3, j = (c + 2) % 3, k = (r + 1) % 3, l = (r + 2) % 3;
            adjoint(r, c) = m(i, k) * m(j, l) - m(i, l) * m(j, k);
        }
    const double determinant = m(0, 0) * adjoint(0, 0) + m(0, 1) * adjoint(1, 0) + m(0, 2) * adjoint(2, 0);
    return adjoint / determinant;
}

// Linear RGB of the space's primaries -> XYZ, white D65 (0.9505, 1, 1.089) at RGB = 1.
Matrix xyz_matrix(double rx, double ry, double gx, double gy, double bx, double by) {
    Matrix m;
    m << rx / ry, gx / gy, bx / by, 1, 1, 1, (1 - rx - ry) / ry, (1 - gx - gy) / gy, (1 - bx - by) / by;
    const Vec3d white(kWhiteX / kWhiteY, 1.0, (1 - kWhiteX - kWhiteY) / kWhiteY);
    const Vec3d scale = times(inverse(m), white);
    return m * scale.asDiagonal();
}

struct Matrices {
    Matrix srgb_to_xyz = xyz_matrix(0.64, 0.33, 0.30, 0.60, 0.15, 0.06);
    Matrix xyz_to_srgb = inverse(srgb_to_xyz);
    Matrix adobe_to_srgb = times(xyz_to_srgb, xyz_matrix(0.64, 0.33, 0.21, 0.71, 0.15, 0.06));
    Matrix srgb_to_adobe = inverse(adobe_to_srgb);
    Matrix p3_to_srgb = times(xyz_to_srgb, xyz_matrix(0.680, 0.320, 0.265, 0.690, 0.150, 0.060));
    Matrix srgb_to_p3 = inverse(p3_to_srgb);
};
const Matrices& matrices() {
    static const Matrices kMatrices;
    return kMatrices;
}

double cube(double x) {
    return x * x * x;
}

}  // namespace

std::string_view color_space_name(ColorSpace space) {
    for (const auto& [value, name] : kNames)
        if (value == space) return name;
    return "sRGB";
}

std::optional<ColorSpace> parse_color_space(std::string_view name) {
    const auto same = [](char a, char b) {
        return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
    };
    for (const auto& [value, known] : kNames)
        if (std::equal(name.begin(), name.end(), known.begin(), known.end(), same)) return value;
    return std::nullopt;
}

Vec3f linear_from_encoded(ColorSpace space, const Vec3f& encoded) {
    Vec3d linear;
    for (int c = 0; c < 3; ++c)
        linear[c] = std::copysign(decode_curve(space, std::abs(double(encoded[c]))), double(encoded[c]));
    if (space == ColorSpace::kAdobeRgb) linear = times(matrices().adobe_to_srgb, linear);
    if (space == ColorSpace::kDisplayP3) linear = times(matrices().p3_to_srgb, linear);
    return linear.cast<float>();
}

Vec3f encoded_from_linear(ColorSpace space, const Vec3f& linear) {
    Vec3d x = linear.cast<double>();
    if (space == ColorSpace::kAdobeRgb) x = times(matrices().srgb_to_adobe, x);
    if (space == ColorSpace::kDisplayP3) x = times(matrices().srgb_to_p3, x);
    Vec3f encoded;
    for (int c = 0; c < 3; ++c)
        encoded[c] = static_cast<float>(std::copysign(encode_curve(space, std::abs(x[c])), x[c]));
    return encoded;
}

float encoded_grey(ColorSpace space, float linear) {
    const double x = linear;
    return static_cast<float>(std::copysign(encode_curve(space, std::abs(x)), x));
}

Eigen::Matrix3d rgb_from_xyz(ColorSpace space) {
    const Matrices& m = matrices();
    if (space == ColorSpace::kAdobeRgb) return times(m.srgb_to_adobe, m.xyz_to_srgb);
    if (space == ColorSpace::kDisplayP3) return times(m.srgb_to_p3, m.xyz_to_srgb);
    return m.xyz_to_srgb;
}

Eigen::Matrix3d xyz_from_linear() {
    return matrices().srgb_to_xyz;
}

Vec3f luv_from_linear(const Vec3f& linear) {
    const Vec3d xyz = times(matrices().srgb_to_xyz, Vec3d(linear.cast<double>()));
    const double y = xyz[1];
    const double lightness = y > kLinearLimit ? 116 * std::cbrt(y) - 16 : kLinearSlope * y;
    const double sum = xyz[0] + 15 * y + 3 * xyz[2];
    if (sum <= 0) return {static_cast<float>(lightness), 0, 0};
    return {static_cast<float>(lightness), static_cast<float>(13 * lightness * (4 * xyz[0] / sum - kWhiteU)),
            static_cast<float>(13 * lightness * (9 * y / sum - kWhiteV))};
}

Vec3f linear_from_luv(const Vec3f& luv) {
    const double lightness = luv[0];
    const double y =
        lightness > kLinearSlope * kLinearLimit ? cube((lightness + 16) / 116) : lightness / kLinearSlope;
    double u = kWhiteU, v = kWhiteV;
    if (lightness > 0) {
        u += luv[1] / (13 * lightness);
        v += luv[2] / (13 * lightness);
    }
    // Far outside any gamut v' can reach 0 or less, where X and Z are undefined; stay just above.
    constexpr double kLeastV = 1e-3;
    v = std::max(v, kLeastV);
    const Vec3d xyz(y * 9 * u / (4 * v), y, y * (12 - 3 * u - 20 * v) / (4 * v));
    return times(matrices().xyz_to_srgb, xyz).cast<float>();
}

namespace {

// The channels of an image's colour. Grey counts as R = G = B.
struct ColorChannels {
    int r, g, b;

    explicit ColorChannels(const Image& image)
        : r(image.channel("R")), g(image.channel("G")), b(image.channel("B")) {
        if (std::min({r, g, b}) < 0) r = g = b = image.channel("Y");
    }
    bool any() const { return r >= 0; }
    Vec3f at(const float* pixel) const { return {pixel[r], pixel[g], pixel[b]}; }
};

}  // namespace

Gamut gamut_of(const Image& image, const Mask& mask) {
    const ColorChannels channels(image);
    const bool floats = image.sample_type == SampleType::kHalf || image.sample_type == SampleType::kFloat;
    for (std::size_t i = 0; floats && channels.any() && i < image.pixel_count(); ++i) {
        const Vec3f encoded = channels.at(image.pixel(i));
        if (mask.contains(i) && linear_from_encoded(image.color_space, encoded).maxCoeff() > 1)
            return Gamut::kHdr;
    }
    return Gamut::kDisplay;
}

FeatureImage luv_image(const Image& image, Range range) {
    const ColorChannels channels(image);
    if (!channels.any())
        throw Error(ErrorKind::kUnsupported, "the image has no colour: neither channels R, G, B nor Y");
    const LuvDecoder decoder(image.color_space, range, image.sample_type == SampleType::kUint8);
    FeatureImage out{image.width, image.height, 3, parallel_vector<float>(image.pixel_count() * 3)};
    parallel_blocks(0, image.height, kGrainRows, [&](int first, int last) {
        std::vector<float> planes;
        for (int y = first; y < last; ++y)
            decoder.decode_row(image.row(y).data(), image.channels, {channels.r, channels.g, channels.b},
                               image.width, planes, out.row(y).data());
    });
    return out;
}

}  // namespace imgmesh
