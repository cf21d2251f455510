#include "libcore/optimize/grid_state.h"

#include <algorithm>

#include "libcore/base/for_each_id.h"
#include "libcore/mesh/adjacency.h"
#include "libcore/mesh/fixed_axes.h"

namespace imgmesh {
namespace {

// The bits of a number, each followed by a zero.
std::uint64_t spread_bits(std::uint64_t n) {
    n = (n | n << 16) & 0x0000FFFF0000FFFFu;
    n = (n | n << 8) & 0x00FF00FF00FF00FFu;
    n = (n | n << 4) & 0x0F0F0F0F0F0F0F0Fu;
    n = (n | n << 2) & 0x3333333333333333u;
    return (n | n << 1) & 0x5555555555555555u;
}
// The place along a Z-shaped curve that fills the plane.
std::uint64_t along_curve(const Place& place) {
    return spread_bits(static_cast<std::uint32_t>(place.x)) | spread_bits(static_cast<std::uint32_t>(place.y))
                                                                  << 1;
}

}  // namespace

GridState::GridState(const RowSums& sums, const PlacedMesh& mesh, const PlaceGrid& grid,
                     const FaceRules& rules)
    : sums_(&sums),
      grid_(grid),
      rules_(rules),
      mesh_(mesh.faces, mesh.spot.size()),
      vertex_(mesh.spot.size()),
      spot_(mesh.spot),
      cost_(mesh.faces.size()) {
    low_ = high_ = spot_.front().place;
    for (std::size_t v = 0; v < vertex_.size(); ++v) {
        const Place& p = spot_[v].place;
        vertex_[v].column = grid_.column(p.x);
        vertex_[v].row = grid_.row(p.y);
        vertex_[v].fixed = mesh.fixed[v];
        low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
        high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y)};
    }
    set_rules(rules);
}

void GridState::set_rules(const FaceRules& rules) {
    rules_ = rules;
    for (Id f = 0; f < cost_.size(); ++f)
        if (mesh_.live_face(f)) cost_[f] = face_cost(mesh_.face(f));
    all_changed();
}

void GridState::set_pattern(int longest, int first) {
    longest_step_ = longest;
    first_step_ = static_cast<std::uint8_t>(first);
    for (Vertex& v : vertex_) v.step = first_step_;
}

double GridState::face_cost(const Face& face) const {
    const auto [a, b, c] = face;
    const FaceFit fit = face_fit(*sums_, spot_[a].place, spot_[b].place, spot_[c].place);
    return fit.error(spot_[a].color, spot_[b].color, spot_[c].color) +
           rules_.shape_cost(spot_[a].place, spot_[b].place, spot_[c].place);
}

double GridState::cost() const {
    double sum = 0;
    for (Id f = 0; f < cost_.size(); ++f)
        if (mesh_.live_face(f)) sum += cost_[f];
    return sum;
}

double GridState::squared_error() const {
    double sum = 0;
    for (Id f = 0; f < cost_.size(); ++f)
        if (const auto [a, b, c] = mesh_.face(f); mesh_.live_face(f))
            sum += cost_[f] - rules_.shape_cost(spot_[a].place, spot_[b].place, spot_[c].place);
    return sum;
}

std::size_t GridState::faces() const {
    std::size_t count = 0;
    for (Id f = 0; f < cost_.size(); ++f) count += mesh_.live_face(f);
    return count;
}

std::size_t GridState::border_vertices() const {
    std::size_t count = 0;
    for (Id v = 0; v < vertex_.size(); ++v) count += mesh_.live_vertex(v) && vertex_[v].fixed != 0;
    return count;
}

PlacedMesh GridState::result() const {
    PlacedMesh out;
    std::vector<Id> id(mesh_.vertices(), kNone);
    for (Id v = 0; v < mesh_.vertices(); ++v) {
        if (!mesh_.live_vertex(v)) continue;
        id[v] = as_id(out.spot.size());
        out.spot.push_back(spot_[v]);
        out.fixed.push_back(vertex_[v].fixed);
    }
    for (Id f = 0; f < cost_.size(); ++f)
        if (const auto [a, b, c] = mesh_.face(f); mesh_.live_face(f))
            out.faces.push_back({id[a], id[b], id[c]});
    return out;
}

void GridState::reorder() {
    std::vector<std::pair<std::uint64_t, Id>> order;
    for (Id v = 0; v < mesh_.vertices(); ++v)
        if (mesh_.live_vertex(v)) order.emplace_back(along_curve(spot_[v].place), v);
    std::sort(order.begin(), order.end());
    std::vector<Id> id(mesh_.vertices(), kNone);
    std::vector<Vertex> vertices;
    std::vector<Spot> spots;
    for (const auto& [curve, v] : order) {
        id[v] = as_id(vertices.size());
        vertices.push_back(vertex_[v]);
        spots.push_back(spot_[v]);
        vertices.back().removal_holds = false;
    }
    std::vector<std::pair<Face, double>> faces;
    for (Id f = 0; f < cost_.size(); ++f) {
        if (!mesh_.live_face(f)) continue;
        Face face = mesh_.face(f);
        for (Id& v : face) v = id[v];
        // The lowest corner first: so faces have one order.
        std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
        faces.emplace_back(face, cost_[f]);
    }
    std::sort(faces.begin(), faces.end());
    std::vector<Face> corners;
    cost_.clear();
    for (const auto& [face, error] : faces) {
        corners.push_back(face);
        cost_.push_back(error);
    }
    all_changed();
    vertex_ = std::move(vertices);
    spot_ = std::move(spots);
    mesh_ = EditMesh(std::move(corners), vertex_.size());
}

void GridState::fit_colors(int passes) {
    std::vector<FaceFit> fits(cost_.size());
    for_each_id(cost_.size(), [&](Id f) {
        if (!mesh_.live_face(f)) return;
        const auto& [a, b, c] = mesh_.face(f);
        fits[f] = face_fit(*sums_, spot_[a].place, spot_[b].place, spot_[c].place);
    });
    const VertexCorners corners = vertex_corners(mesh_.faces(), mesh_.vertices());
    const auto fit = [&](Id v) {
        if (corners.of(v).empty() || (vertex_[v].fixed & kFixedColor)) return;
        double weight = kColorPull;
        Double4 rhs = kColorPull * spot_[v].color;
        for (const std::size_t corner : corners.of(v)) {
            const FaceFit& of_face = fits[corner / 3];
            const Face& face = mesh_.faces()[corner / 3];
            const std::size_t i = corner % 3, j = (i + 1) % 3, m = (i + 2) % 3;
            weight += of_face.gram[i][i];
            rhs += of_face.rhs[i] - of_face.gram[i][j] * spot_[face[j]].color -
                   of_face.gram[i][m] * spot_[face[m]].color;
        }
        const Double4 best = rhs / weight;
        spot_[v].color = rules_.allowed(best);
    };
    const GridTiles tiles(mesh_.faces(), mesh_.vertices());
    for (int pass = 0; pass < passes; ++pass)
        tiles.for_each([&](const Turn& turn) {
            for (Id v = turn.first; v < turn.last; ++v) fit(v);
        });
    for_each_id(cost_.size(), [&](Id f) {
        if (!mesh_.live_face(f)) return;
        const auto& [a, b, c] = mesh_.face(f);
        cost_[f] = fits[f].error(spot_[a].color, spot_[b].color, spot_[c].color) +
                   rules_.shape_cost(spot_[a].place, spot_[b].place, spot_[c].place);
    });
    for (Vertex& v : vertex_) v.removal_holds = false;
    all_changed();
}

std::uint8_t GridState::side_of(Id a, Id b) const {
    if (vertex_[a].fixed & vertex_[b].fixed & kFixedColor) return kFixedX | kFixedY;
    const Place &p = spot_[a].place, &q = spot_[b].place;
    if (p.x == q.x && (p.x == low_.x || p.x == high_.x)) return kFixedX;
    if (p.y == q.y && (p.y == low_.y || p.y == high_.y)) return kFixedY;
    return kFixedX | kFixedY;
}

void GridState::all_changed() {
    changed_.assign(cost_.size(), ++tick_);
}

void GridState::changed(Id f, std::uint64_t& tick) {
    changed_[f] = ++tick;
    for (const Id v : mesh_.face(f))
        if (v != kNone) vertex_[v].removal_holds = false;
}

}  // namespace imgmesh
