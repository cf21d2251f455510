#include "libcore/refine/refiner.h"

#include <algorithm>
#include <cmath>

#include "libcore/base/dot.h"
#include "libcore/base/for_each_id.h"
#include "libcore/image/color.h"
#include "libcore/mesh/vertex_coloring.h"

namespace imgmesh {

// No new triangle is thinner than the collapse allows (simplify/kernel/shape_limits.h).
constexpr double kFatness = 0.05;

void Refiner::add_shape(Cost& cost, const Vec2f& a, const Vec2f& b, const Vec2f& c) const {
    const double area2 = signed_area2(a, b, c);
    const double ab = (b - a).squaredNorm(), bc = (c - b).squaredNorm(), ca = (a - c).squaredNorm();
    if (!(area2 > kFatness * std::max({ab, bc, ca})) || area2 > 2 * params_.max_face_area) cost.legal = false;
    const double q = area2 > 0 ? 2 * std::sqrt(3.0) * area2 / (ab + bc + ca) : 1e-6;
    cost.least_q = std::min(cost.least_q, q);
    cost.shape += 1 / q - 1;
}

Refiner::Refiner(const BaseMesh& mesh, const ImagePlanes& image, const RefineParams& params)
    : image_(image),
      params_(params),
      mesh_(refine_faces(mesh)),
      vertex_(mesh),
      error_(mesh.faces.size(), 0.0) {
    fit_colors();
    shape_unit_ = params.shape_weight * total_error() / static_cast<double>(mesh.faces.size());
}

double Refiner::total_error() const {
    double sum = 0;
    for (Id f = 0; f < mesh_.faces().size(); ++f)
        if (mesh_.live_face(f)) sum += error_[f];
    return sum;
}

Vec3f Refiner::allowed(const Vec3f& color) const {
    if (params_.range == ColorRange::kLuv) return in_gamut(color);
    return color.cwiseMax(0.0f).cwiseMin(1.0f);
}

bool Refiner::better(const Cost& now, const Cost& before) const {
    // Gains within the rounding of the sums do not count.
    const double slack = 1e-5 * before.error + 1e-9;
    if (!now.legal) return false;
    // A face below the floor may only become better.
    if (now.least_q < params_.min_quality && now.least_q < before.least_q) return false;
    return now.error + shape_unit_ * now.shape < before.error + shape_unit_ * before.shape - slack;
}

double Refiner::face_error(const Face& face) const {
    return squared_error(image_, corner(face[0]), corner(face[1]), corner(face[2]));
}

Refiner::Cost Refiner::cost_of(const OneRing& ring) const {
    Cost cost;
    for (std::size_t k = 0; k < ring.faces; ++k) {
        const Id f = ring.face[k];
        const auto [a, b, c] = mesh_.face(f);
        cost.error += error_[f];
        add_shape(cost, vertex_.position[a], vertex_.position[b], vertex_.position[c]);
    }
    return cost;
}

// Least squares over all pixels by projected Gauss-Seidel, as in param/fit_colors.cpp, on changes of the
// colours; the faces' errors follow from the same sums.
void Refiner::fit_colors() {
    std::vector<FaceSums> sums(mesh_.faces().size());
    for_each_id(mesh_.faces().size(), [&](Id f) {
        if (!mesh_.live_face(f)) return;
        const auto [a, b, c] = mesh_.face(f);
        sums[f] = face_sums(image_, corner(a), corner(b), corner(c));
    });
    forget();
    const std::vector<Vec3f> before = vertex_.color;
    std::vector<Vec3d> change(mesh_.vertices(), Vec3d::Zero());
    constexpr int kPasses = 6;
    // A vertex that no pixel touches stays unchanged.
    constexpr double kPull = 1e-3;
    // The corners around each vertex, 3 face + place, in the order of its ring: every pass needs them.
    std::vector<Id> corners, first{0};
    OneRing ring;
    for (Id v = 0; v < mesh_.vertices(); ++v) {
        const std::size_t faces = mesh_.ring(v, ring) ? ring.faces : 0;
        for (std::size_t k = 0; k < faces; ++k) corners.push_back(3 * ring.face[k] + ring.corner[k]);
        first.push_back(static_cast<Id>(corners.size()));
    }
    const auto improve = [&](Id v) {
        if (first[v] == first[v + 1]) return;
        double diagonal = kPull;
        Vec3d rhs = kPull * change[v];
        for (Id k = first[v]; k < first[v + 1]; ++k) {
            const Id f = corners[k] / 3;
            const std::size_t i = corners[k] % 3;
            diagonal += sums[f].ww[i][i];
            rhs -= sums[f].we[i];
            for (const std::size_t j : {(i + 1) % 3, (i + 2) % 3})
                rhs -= sums[f].ww[i][j] * change[mesh_.face(f)[j]];
        }
        const Vec3f best = before[v] + (rhs / diagonal).cast<float>(), next = allowed(best);
        if ((next - best).squaredNorm() >= (vertex_.color[v] - best).squaredNorm()) return;
        vertex_.color[v] = next;
        change[v] = (next - before[v]).cast<double>();
    };
    const std::vector<std::vector<Id>> classes = vertex_coloring(mesh_.faces(), mesh_.vertices());
    for (int pass = 0; pass < kPasses; ++pass)
        for (const std::vector<Id>& members : classes)
            for_each_id(members.size(), [&](Id k) { improve(members[k]); });
    for_each_id(mesh_.faces().size(), [&](Id f) {
        if (!mesh_.live_face(f)) return;
        double e = sums[f].ee;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3d& di = change[mesh_.face(f)[i]];
            e += 2 * dot(di, sums[f].we[i]);
            for (std::size_t j = 0; j < 3; ++j) e += sums[f].ww[i][j] * dot(di, change[mesh_.face(f)[j]]);
        }
        error_[f] = std::max(0.0, e);
    });
}

bool Refiner::place(const OneRing& ring, const Vec2f& position, const Vec3f& color, double least_q,
                    Placement& out) const {
    out.position = position;
    out.cost = {};
    std::array<CornerSums, OneRing::kMaxFaces> sums;
    double ww = 1e-3;
    Vec3d we = Vec3d::Zero();
    for (std::size_t k = 0; k < ring.faces; ++k)
        add_shape(out.cost, position, vertex_.position[ring.vertex[k]], vertex_.position[ring.vertex[k + 1]]);
    if (!out.cost.legal || out.cost.least_q < std::min(least_q, params_.min_quality)) return false;
    for (std::size_t k = 0; k < ring.faces; ++k) {
        sums[k] = corner_sums(image_, {position, color}, corner(ring.vertex[k]), corner(ring.vertex[k + 1]));
        ww += sums[k].ww;
        we += sums[k].we;
    }
    out.color = allowed(color - (we / ww).cast<float>());
    const Vec3d change = (out.color - color).cast<double>();
    for (std::size_t k = 0; k < ring.faces; ++k) {
        out.face_error[k] =
            std::max(0.0, sums[k].ee + 2 * dot(change, sums[k].we) + sums[k].ww * dot(change, change));
        out.cost.error += out.face_error[k];
    }
    return true;
}

void Refiner::set(const OneRing& ring, Id v, const Placement& placement) {
    vertex_.position[v] = placement.position;
    vertex_.color[v] = placement.color;
    for (std::size_t k = 0; k < ring.faces; ++k) error_[ring.face[k]] = placement.face_error[k];
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
        const CornerSums sums = corner_sums(image_, own, b, c);
        const Vec2d pb = (b.position - own.position).cast<double>(),
                    pc = (c.position - own.position).cast<double>();
        const Vec3d db = (b.color - own.color).cast<double>(), dc = (c.color - own.color).cast<double>();
        const double det = pb.x() * pc.y() - pb.y() * pc.x();
        const Vec3d gx = (pc.y() * db - pb.y() * dc) / det, gy = (pb.x() * dc - pc.x() * db) / det;
        hxx += sums.ww * dot(gx, gx);
        hxy += sums.ww * dot(gx, gy);
        hyy += sums.ww * dot(gy, gy);
        rhs += Vec2d(dot(gx, sums.we), dot(gy, sums.we));
        mx += sums.ww * gx;
        my += sums.ww * gy;
        we += sums.we;
        ww += sums.ww;
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
    if (vertex_.fixed[v] == RefineVertices::kFixed || !mesh_.ring(v, ring)) return false;
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
        if (place(ring, p, vertex_.color[v], before.least_q, placement) && better(placement.cost, before)) {
            set(ring, v, placement);
            return true;
        }
    }
    return false;
}

std::int64_t Refiner::move_vertices() {
    forget();
    std::vector<std::uint8_t> moved(mesh_.vertices(), false);
    for (const std::vector<Id>& members : vertex_coloring(mesh_.faces(), mesh_.vertices()))
        for_each_id(members.size(), [&](Id k) { moved[members[k]] = move_vertex(members[k]); });
    return std::count(moved.begin(), moved.end(), true);
}

bool Refiner::flip_is_better(Id f, std::size_t i, Id g, double& first, double& second) const {
    const Id p = mesh_.face(f)[i], a = mesh_.face(f)[(i + 1) % 3], b = mesh_.face(f)[(i + 2) % 3];
    const Id q = mesh_.apex(g, f);
    Cost before, after;
    add_shape(after, vertex_.position[p], vertex_.position[a], vertex_.position[q]);
    add_shape(after, vertex_.position[q], vertex_.position[b], vertex_.position[p]);
    if (!after.legal) return false;
    before.error = error_[f] + error_[g];
    add_shape(before, vertex_.position[p], vertex_.position[a], vertex_.position[b]);
    add_shape(before, vertex_.position[q], vertex_.position[b], vertex_.position[a]);
    first = face_error({p, a, q});
    second = face_error({q, b, p});
    after.error = first + second;
    return better(after, before);
}

bool Refiner::flip_if_better(Id f, std::size_t i, Id g) {
    double first = 0, second = 0;
    if (!flip_is_better(f, i, g, first, second) || !mesh_.may_flip(f, i)) return false;
    mesh_.flip(f, i);
    error_[f] = first;
    error_[g] = second;
    changed(f);
    changed(g);
    return true;
}

std::int64_t Refiner::flip_edges() {
    // All threads compute the effects of flips. They hold for pairs of faces that no earlier flip has
    // changed, so the outcome is that of one edge after the other.
    const std::size_t faces = mesh_.faces().size();
    std::vector<Face> across(faces, {kNone, kNone, kNone});
    std::vector<std::array<bool, 3>> worthwhile(faces);
    for_each_id(faces, [&](Id f) {
        if (!mesh_.live_face(f)) return;
        double first = 0, second = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const Id g = across[f][i] = mesh_.across(f, i);
            worthwhile[f][i] = g != kNone && f < g && flip_is_better(f, i, g, first, second);
        }
    });
    std::vector<bool> flipped(faces, false);
    std::int64_t flips = 0;
    for (Id f = 0; f < faces; ++f)
        for (std::size_t i = 0; i < 3; ++i) {
            Id g = across[f][i];
            const bool is_new = flipped[f] || (g != kNone && flipped[g]);
            if (is_new) g = mesh_.across(f, i);
            if (g == kNone || f > g || !(worthwhile[f][i] || is_new) || !flip_if_better(f, i, g)) continue;
            flipped[f] = flipped[g] = true;
            ++flips;
        }
    return flips;
}

}  // namespace imgmesh
