#include "formats/picture/color/primaries.h"

#include <Eigen/LU>
#include <cmath>

#include "libcore/base/error.h"

namespace imgmesh {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;

// X, Y, Z of luminance 1. A primary may have no luminance of its own, so this is only for whites.
Vector3d white_xyz(const Chromaticity& c) {
    return {c.x / c.y, 1, (1 - c.x - c.y) / c.y};
}

// Returns X, Y, Z of linear RGB; RGB = 1 is the white.
Matrix3d xyz_from_rgb(const Primaries& p) {
    Matrix3d directions;
    int column = 0;
    for (const Chromaticity& c : {p.red, p.green, p.blue})
        directions.col(column++) << c.x, c.y, 1 - c.x - c.y;
    const Vector3d amounts = directions.inverse() * white_xyz(p.white);
    return directions * amounts.asDiagonal();
}

Matrix3d adaptation(const Chromaticity& from, const Chromaticity& to) {
    Matrix3d cones;
    cones << 0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296;
    const Vector3d scale = (cones * white_xyz(to)).cwiseQuotient(cones * white_xyz(from));
    return cones.inverse() * scale.asDiagonal() * cones;
}

}  // namespace

bool same_primaries(const Primaries& a, const Primaries& b) {
    constexpr double kTolerance = 0.001;
    const auto near = [](const Chromaticity& p, const Chromaticity& q) {
        return std::abs(p.x - q.x) <= kTolerance && std::abs(p.y - q.y) <= kTolerance;
    };
    return near(a.red, b.red) && near(a.green, b.green) && near(a.blue, b.blue) && near(a.white, b.white);
}

void convert_primaries(const std::string& path, const Primaries& from, const Primaries& to, Image& image) {
    const int red = image.channel("R"), green = image.channel("G"), blue = image.channel("B");
    if (red < 0 || green < 0 || blue < 0 || same_primaries(from, to)) return;
    const Matrix3d m = xyz_from_rgb(to).inverse() * adaptation(from.white, to.white) * xyz_from_rgb(from);
    // Real spaces need numbers of about 3, and their matrices can be inverted.
    constexpr double kLargest = 1000, kLeast = 1e-6;
    if (!m.allFinite() || m.cwiseAbs().maxCoeff() > kLargest || std::abs(m.determinant()) < kLeast)
        throw Error(ErrorKind::kBadFile, cat(path, ": the primaries that it states span no colour space"));
    const auto step = static_cast<std::size_t>(image.channels);
    for (std::size_t i = 0; i < image.data.size(); i += step) {
        float* const p = image.data.data() + i;
        const Vector3d rgb = m * Vector3d(p[red], p[green], p[blue]);
        p[red] = static_cast<float>(rgb[0]);
        p[green] = static_cast<float>(rgb[1]);
        p[blue] = static_cast<float>(rgb[2]);
    }
}

}  // namespace imgmesh
