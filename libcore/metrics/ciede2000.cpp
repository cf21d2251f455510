// Numbers in brackets are the equations of Sharma et al. 2005.
#include "libcore/metrics/ciede2000.h"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "libcore/image/cie.h"
#include "libcore/image/color.h"

namespace imgmesh {
namespace {

constexpr double kPi = std::numbers::pi;

double radians(double degrees) {
    return degrees * kPi / 180;
}

double power7(double x) {
    const double cubed = x * x * x;
    return cubed * cubed * x;
}

// Returns C^7 / (C^7 + 25^7), which grows from 0 to 1 with chroma.
double chroma_share(double chroma) {
    return power7(chroma) / (power7(chroma) + power7(25));
}

// Returns the hue angle in [0, 2 pi), (7); 0 for grey.
double hue_angle(double a, double b) {
    if (a == 0 && b == 0) return 0;
    const double hue = std::atan2(b, a);
    return hue < 0 ? hue + 2 * kPi : hue;
}

// The function f of L*a*b* (CIE 15): the cube root, and its tangent near black.
double lab_curve(double t) {
    return t > kLinearLimit ? std::cbrt(t) : (kLinearSlope * t + 16) / 116;
}

}  // namespace

Vec3d lab_from_linear(const Vec3f& linear) {
    static const Eigen::Matrix3d kXyzFromRgb = rgb_from_xyz(ColorSpace::kSrgb).inverse();
    static const Vec3d kWhite = kXyzFromRgb * Vec3d::Ones();
    const Vec3d xyz = (kXyzFromRgb * linear.cast<double>()).cwiseQuotient(kWhite);
    const double x = lab_curve(xyz[0]), y = lab_curve(xyz[1]), z = lab_curve(xyz[2]);
    return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

double ciede2000(const Vec3d& lab_1, const Vec3d& lab_2) {
    const double mean_ab = (std::hypot(lab_1[1], lab_1[2]) + std::hypot(lab_2[1], lab_2[2])) / 2;  // (2, 3)
    const double stretch = 1 + 0.5 * (1 - std::sqrt(chroma_share(mean_ab)));                       // (4, 5)
    const double a1 = stretch * lab_1[1], a2 = stretch * lab_2[1], b1 = lab_1[2], b2 = lab_2[2];
    const double c1 = std::hypot(a1, b1), c2 = std::hypot(a2, b2);  // (6)
    const double h1 = hue_angle(a1, b1), h2 = hue_angle(a2, b2);    // (7)
    const double delta_l = lab_2[0] - lab_1[0], delta_c = c2 - c1;  // (8, 9)

    // The shorter way round from one hue to the other, (10). It is 0 if either is grey.
    const bool grey = c1 * c2 == 0;
    double turn = grey ? 0 : h2 - h1;
    if (turn > kPi) turn -= 2 * kPi;
    if (turn < -kPi) turn += 2 * kPi;
    const double delta_h = 2 * std::sqrt(c1 * c2) * std::sin(turn / 2);  // (11)

    const double mean_l = (lab_1[0] + lab_2[0]) / 2, mean_c = (c1 + c2) / 2;  // (12, 13)
    double mean_h = grey ? h1 + h2 : (h1 + h2) / 2;                           // (14)
    if (!grey && std::abs(h1 - h2) > kPi) mean_h += h1 + h2 < 2 * kPi ? kPi : -kPi;

    const double t = 1 - 0.17 * std::cos(mean_h - radians(30)) + 0.24 * std::cos(2 * mean_h) +
                     0.32 * std::cos(3 * mean_h + radians(6)) -
                     0.20 * std::cos(4 * mean_h - radians(63));  // (15)
    const double from_blue = (mean_h - radians(275)) / radians(25);
    const double rotation = radians(30) * std::exp(-from_blue * from_blue);  // (16)
    const double rc = 2 * std::sqrt(chroma_share(mean_c));                   // (17)
    const double from_middle = (mean_l - 50) * (mean_l - 50);
    const double sl = 1 + 0.015 * from_middle / std::sqrt(20 + from_middle);  // (18)
    const double sc = 1 + 0.045 * mean_c, sh = 1 + 0.015 * mean_c * t;        // (19, 20)
    const double rt = -std::sin(2 * rotation) * rc;                           // (21)
    const double l = delta_l / sl, c = delta_c / sc, h = delta_h / sh;
    return std::sqrt(l * l + c * c + h * h + rt * c * h);  // (22)
}

}  // namespace imgmesh
