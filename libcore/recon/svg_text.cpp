#include "libcore/recon/svg_text.h"

#include <cmath>
#include <cstdlib>

#include "libcore/mesh/outer_edge.h"

namespace imgmesh {

void append_number(std::string& out, double value) {
    long hundredths = std::lround(value * 100);
    if (hundredths < 0) out += '-';
    hundredths = std::abs(hundredths);
    if (hundredths >= 100 || hundredths == 0) out += std::to_string(hundredths / 100);
    if (hundredths % 100 == 0) return;
    out += '.';
    out += static_cast<char>('0' + hundredths / 10 % 10);
    if (hundredths % 10 != 0) out += static_cast<char>('0' + hundredths % 10);
}

void append_point(std::string& out, char command, const Vec2d& p) {
    out += command;
    append_number(out, p.x());
    out += ' ';
    append_number(out, p.y());
}

std::vector<Vec2d> outward(const Level& level, const SourceInfo& source) {
    const BaseMesh& mesh = level.mesh;
    std::vector<Vec2d> points;
    points.reserve(mesh.vertex_count());
    if (source.has_mask) {
        for (const Vec2f& p : outer_positions(mesh, level.map)) points.push_back(p.cast<double>());
        return points;
    }
    const auto moved = [&](float x, int side) {
        if (side == 1) return double(x);  // already -0.5 .. 0.5
        if (x <= 0) return x - 0.5;
        return x >= static_cast<float>(side - 1) ? x + 0.5 : double(x);
    };
    for (const Vec2f& p : mesh.position)
        points.emplace_back(moved(p.x(), source.width), moved(p.y(), source.height));
    return points;
}

void append_hex(std::string& out, const Vec3d& codes) {
    constexpr char kDigits[] = "0123456789abcdef";
    out += '#';
    for (int c = 0; c < 3; ++c) {
        const auto byte = static_cast<unsigned>(std::lround(codes[c]));
        out += kDigits[byte >> 4];
        out += kDigits[byte & 15];
    }
}

}  // namespace imgmesh
