#include "libcore/refine/refiner.h"

#include <algorithm>
#include <cmath>

#include "libcore/base/dot.h"
#include "libcore/base/for_each_id.h"
#include "libcore/image/color.h"
#include "libcore/mesh/adjacency.h"

namespace imgmesh {

// No new triangle is thinner than the collapse allows (simplify/kernel/shape_limits.h).
constexpr double kFatness = 0.05;

double Refiner::add_shape(Cost& cost, const Vec2f& a, const Vec2f& b, const Vec2f& c) const {
    const double area2 = signed_area2(a, b, c);
    const double ab = (b - a).squaredNorm(), bc = (c - b).squaredNorm(), ca = (a - c).squaredNorm();
    if (!(area2 > kFatness * std::max({ab, bc, ca})) || area2 > 2 * params_.max_face_area) cost.legal = false;
    constexpr double kRegular = 3.4641016151377545871;  // 2 sqrt(3)
    const double inverse_q = area2 > 0 ? (ab + bc + ca) / (kRegular * area2) : 1e6;
    cost.worst = std::max(cost.worst, inverse_q);
    cost.shape += inverse_q - 1;
    return inverse_q;
}

// A face below the floor may only become better.
bool Refiner::too_thin(const Cost& now, const Cost& before) const {
    return now.worst * params_.min_quality > 1 - 1e-12 && now.worst > before.worst;
}

Refiner::Refiner(const BaseMesh& mesh, const ImagePlanes& image, const RefineParams& params)
    : image_(image),
      params_(params),
      mesh_(refine_faces(mesh)),
      vertex_(mesh, params.keep_sides ? &image : nullptr),
      sums_(mesh.faces.size()),
      inverse_q_(mesh.faces.size()) {
    for_each_id(sums_.size(), [&](Id f) { measure(f); });
    fit_colors();
    shape_unit_ = params.shape_weight * total_error() / static_cast<double>(mesh.faces.size());
}

double Refiner::total_error() const {
    double sum = 0;
    for (Id f = 0; f < mesh_.faces().size(); ++f)
        if (mesh_.live_face(f)) sum += sums_[f].ee;
    return sum;
}

Vec3f Refiner::allowed(const Vec3f& color) const {
    if (params_.range == ColorRange::kLuv) return in_gamut(color);
    return color.cwiseMax(0.0f).cwiseMin(1.0f);
}

bool Refiner::better(const Cost& now, const Cost& before) const {
    // Gains within the rounding of the sums do not count.
    const double slack = 1e-5 * before.error + 1e-9;
    if (!now.legal || too_thin(now, before)) return false;
    return now.error + shape_unit_ * now.shape < before.error + shape_unit_ * before.shape - slack;
}

FaceSums Refiner::sums_of(const Face& face) const {
    return face_sums(image_, corner(face[0]), corner(face[1]), corner(face[2]));
}
double Refiner::face_error(const Face& face) const {
    return squared_error(image_, corner(face[0]), corner(face[1]), corner(face[2]));
}

void Refiner::measure(Id f) {
    const Face& face = mesh_.face(f);
    sums_[f] = sums_of(face);
    Cost cost;
    inverse_q_[f] =
        add_shape(cost, vertex_.position[face[0]], vertex_.position[face[1]], vertex_.position[face[2]]);
}

void Refiner::measure_changed() {
    std::sort(unmeasured_.begin(), unmeasured_.end());
    unmeasured_.erase(std::unique(unmeasured_.begin(), unmeasured_.end()), unmeasured_.end());
    for_each_id(unmeasured_.size(), [&](Id k) {
        if (mesh_.live_face(unmeasured_[k])) measure(unmeasured_[k]);
    });
    unmeasured_.clear();
}

void Refiner::add_face(Cost& cost, Id f) const {
    cost.error += sums_[f].ee;
    cost.shape += inverse_q_[f] - 1;
    cost.worst = std::max(cost.worst, inverse_q_[f]);
}

Refiner::Cost Refiner::cost_of(const OneRing& ring) const {
    Cost cost;
    for (std::size_t k = 0; k < ring.faces; ++k) add_face(cost, ring.face[k]);
    return cost;
}

const VertexTiles& Refiner::tiles() {
    if (!tiles_) tiles_.emplace(mesh_.faces(), vertex_.position);
    return *tiles_;
}

// Least squares over all pixels by projected Gauss-Seidel, as in param/fit_colors.cpp, on changes of the
// colours.
void Refiner::fit_colors() {
    const std::vector<Vec3f> before = vertex_.color;
    std::vector<Vec3d> change(mesh_.vertices(), Vec3d::Zero());
    constexpr int kPasses = 3;
    // A vertex that no pixel touches stays unchanged.
    constexpr double kPull = 1e-3;
    const VertexCorners corners = vertex_corners(mesh_.faces(), mesh_.vertices());
    const auto improve = [&](Id v) {
        if (vertex_.fixed[v] & kFixedColor) return;
        double diagonal = kPull;
        Vec3d rhs = kPull * change[v];
        for (const std::size_t corner : corners.of(v)) {
            const FaceSums& sums = sums_[corner / 3];
            const Face& face = mesh_.faces()[corner / 3];
            const std::size_t i = corner % 3, j = (i + 1) % 3, m = (i + 2) % 3;
            diagonal += sums.square[i];
            rhs -= sums.we[i].cast<double>() + sums.product[m] * change[face[j]] +
                   sums.product[j] * change[face[m]];
        }
        const Vec3f best = before[v] + (rhs / diagonal).cast<float>(), next = allowed(best);
        if ((next - best).squaredNorm() >= (vertex_.color[v] - best).squaredNorm()) return;
        vertex_.color[v] = next;
        change[v] = (next - before[v]).cast<double>();
    };
    for (int pass = 0; pass < kPasses; ++pass) tiles().for_each(improve);
    for_each_id(mesh_.faces().size(), [&](Id f) {
        if (!mesh_.live_face(f)) return;
        for (std::size_t i = 0; i < 3; ++i) sums_[f].shift(i, change[mesh_.face(f)[i]]);
    });
}

void Refiner::changed(const OneRing& ring) {
    for (std::size_t k = 0; k < ring.faces; ++k) changed(ring.face[k]);
}
void Refiner::changed(Id f) {
    unmeasured_.push_back(f);
    tiles_.reset();
}

}  // namespace imgmesh
