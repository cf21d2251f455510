// Moves: Gauss-Newton steps on the position and the colour of one vertex.
#include <algorithm>
#include <cmath>

#include "libcore/base/dot.h"
#include "libcore/refine/refiner.h"

namespace imgmesh {

bool Refiner::place(const OneRing& ring, const Vec2f& position, const Vec3f& color, const Cost& before,
                    Placement& out) const {
    out.position = position;
    out.cost = {};
    double ww = 1e-3;
    Vec3d we = Vec3d::Zero();
    for (std::size_t k = 0; k < ring.faces; ++k)
        out.inverse_q[k] = add_shape(out.cost, position, vertex_.position[ring.vertex[k]],
                                     vertex_.position[ring.vertex[k + 1]]);
    if (!out.cost.legal || too_thin(out.cost, before)) return false;
    for (std::size_t k = 0; k < ring.faces; ++k) {
        const Face& face = mesh_.face(ring.face[k]);
        const std::size_t i = ring.corner[k];
        std::array<Corner, 3> at = {corner(face[0]), corner(face[1]), corner(face[2])};
        at[i] = {position, color};
        out.sums[k] = face_sums(image_, at[0], at[1], at[2]);
        ww += out.sums[k].square[i];
        we += out.sums[k].we[i].cast<double>();
    }
    out.color = allowed(color - (we / ww).cast<float>());
    const Vec3d change = (out.color - color).cast<double>();
    for (std::size_t k = 0; k < ring.faces; ++k) {
        out.sums[k].shift(ring.corner[k], change);
        out.cost.error += out.sums[k].ee;
    }
    return true;
}

void Refiner::set(const OneRing& ring, Id v, const Placement& placement) {
    vertex_.position[v] = placement.position;
    vertex_.color[v] = placement.color;
    for (std::size_t k = 0; k < ring.faces; ++k) {
        sums_[ring.face[k]] = placement.sums[k];
        inverse_q_[ring.face[k]] = placement.inverse_q[k];
    }
}

// With e the drawing's error and w the vertex's weight, moving the vertex by d and its colour by s changes a
// pixel's colour by w (s - G d), G the gradient of the pixel's face. Least squares over s leaves
//   (sum ww G'G - M'M / ww) d = sum G'we - M'we / ww,   M = sum ww G.
Vec2f Refiner::newton_step(const OneRing& ring, Id v) const {
    double hxx = 0, hxy = 0, hyy = 0, ww = 1e-3;
    Vec2d rhs = Vec2d::Zero(), center = Vec2d::Zero();
    Vec3d mx = Vec3d::Zero(), my = Vec3d::Zero(), we = Vec3d::Zero();
    const Corner own = corner(v);
    for (std::size_t k = 0; k < ring.faces; ++k) {
        const Corner b = corner(ring.vertex[k]), c = corner(ring.vertex[k + 1]);
        const double face_ww = sums_[ring.face[k]].square[ring.corner[k]];
        const Vec3d face_we = sums_[ring.face[k]].we[ring.corner[k]].cast<double>();
        const Vec2d pb = (b.position - own.position).cast<double>(),
                    pc = (c.position - own.position).cast<double>();
        const Vec3d db = (b.color - own.color).cast<double>(), dc = (c.color - own.color).cast<double>();
        const double det = pb.x() * pc.y() - pb.y() * pc.x();
        const Vec3d gx = (pc.y() * db - pb.y() * dc) / det, gy = (pb.x() * dc - pc.x() * db) / det;
        hxx += face_ww * dot(gx, gx);
        hxy += face_ww * dot(gx, gy);
        hyy += face_ww * dot(gy, gy);
        rhs += Vec2d(dot(gx, face_we), dot(gy, face_we));
        mx += face_ww * gx;
        my += face_ww * gy;
        we += face_we;
        ww += face_ww;
        center += pb + pc;
    }
    center /= static_cast<double>(2 * ring.faces);
    hxx -= dot(mx, mx) / ww;
    hxy -= dot(mx, my) / ww;
    hyy -= dot(my, my) / ww;
    rhs -= Vec2d(dot(mx, we), dot(my, we)) / ww;
    // A pull to the ring's centre: the weight of shape, and a little where colours give no direction.
    const double pull =
        1e-3 * (hxx + hyy) + 1e-6 + (ring.closed ? shape_unit_ / (1 + center.squaredNorm()) : 0);
    hxx += pull;
    hyy += pull;
    if (ring.closed) rhs += shape_unit_ / (1 + center.squaredNorm()) * center;
    const std::uint8_t fixed = vertex_.fixed[v];
    if (fixed == kFixedX) return {0, static_cast<float>(rhs.y() / hyy)};
    if (fixed == kFixedY) return {static_cast<float>(rhs.x() / hxx), 0};
    const double det = hxx * hyy - hxy * hxy;
    if (!(det > 0)) return {0, 0};
    return {static_cast<float>((hyy * rhs.x() - hxy * rhs.y()) / det),
            static_cast<float>((hxx * rhs.y() - hxy * rhs.x()) / det)};
}

bool Refiner::move_vertex(Id v) {
    OneRing ring;
    if (keeps_place(vertex_.fixed[v]) || !mesh_.ring(v, ring)) return false;
    const Cost before = cost_of(ring);
    Vec2f step = newton_step(ring, v);
    double longest = 0;
    for (std::size_t k = 0; k < ring.faces; ++k)
        longest =
            std::max(longest, double((vertex_.position[ring.vertex[k]] - vertex_.position[v]).squaredNorm()));
    if (!std::isfinite(step.x()) || !std::isfinite(step.y())) return false;
    const float limit = static_cast<float>(0.5 * std::sqrt(longest));
    if (step.norm() > limit) step *= limit / step.norm();
    Placement placement;
    constexpr int kHalvings = 3;
    // A side of the mesh need not be on the grid of new positions: that of a strip is half a pixel out.
    const Vec2f from = vertex_.position[v];
    const std::uint8_t fixed = vertex_.fixed[v];
    Vec2f last = from;
    for (int half = 0; half <= kHalvings; ++half, step *= 0.5f) {
        const Vec2f p(fixed == kFixedX ? from.x() : snapped(from.x() + step.x()),
                      fixed == kFixedY ? from.y() : snapped(from.y() + step.y()));
        if (p == from || p == last) break;
        last = p;
        if (place(ring, p, vertex_.color[v], before, placement) && better(placement.cost, before)) {
            set(ring, v, placement);
            return true;
        }
    }
    return false;
}

std::int64_t Refiner::move_vertices() {
    std::vector<std::uint8_t> moved(mesh_.vertices(), false);
    tiles().for_each([&](Id v) { moved[v] = move_vertex(v); });
    return std::count(moved.begin(), moved.end(), true);
}

}  // namespace imgmesh
