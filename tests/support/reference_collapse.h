// The collapse written a second time in the simplest way, as the reference for the fast one: a list of faces,
// quadrics as matrices in image coordinates, every edge in one exactly sorted queue, no tiles.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/grid_mesh.h"
#include "tests/support/grid_faces.h"

namespace imgmesh::test {

class ReferenceCollapse {
  public:
    ReferenceCollapse(const GridMesh& grid, const FeatureImage& gradients, double lambda, bool total)
        : total_(total), right_(grid.feature.width - 1), bottom_(grid.feature.height - 1) {
        const int width = grid.feature.width;
        for (Id v = 0; v < grid.vertex_count(); ++v)
            vertices_.push_back({Vec2d(v % static_cast<Id>(width), v / static_cast<Id>(width)), {}, {}, 0});
        const auto color = [](const FeatureImage& image, Id v) {
            return Eigen::Map<const Vec3f>(image.pixel(v)).cast<double>().eval();
        };
        for (const Face& face : grid_faces(grid)) {
            const Id id = static_cast<Id>(faces_.size());
            faces_.push_back(face);
            const auto p = [&](int k) { return vertices_[face[static_cast<std::size_t>(k)]].position; };
            const auto s = [&](int k) { return color(gradients, face[static_cast<std::size_t>(k)]); };
            Eigen::Matrix2d edges;
            edges << p(1) - p(0), p(2) - p(0);
            Eigen::Matrix<double, 3, 2> rise;
            rise << s(1) - s(0), s(2) - s(0);
            const Eigen::Matrix<double, 3, 2> g = rise * edges.inverse();
            const double area = std::abs(edges.determinant()) / 2;
            const Vec2d t = (p(0) + p(1) + p(2)) / 3;
            for (const Id v : face) {
                // lambda |p - t|^2 + |s - g p - d|^2, d such that the plane passes through the vertex.
                Vertex& vertex = vertices_[v];
                vertex.faces.insert(id);
                const Vec3d d = color(grid.feature, v) - g * vertex.position;
                Eigen::Matrix<double, 3, 5> m;
                m << -g, Eigen::Matrix3d::Identity();
                vertex.quadric.a += area * m.transpose() * m;
                vertex.quadric.a.topLeftCorner<2, 2>() += area * lambda * Eigen::Matrix2d::Identity();
                vertex.quadric.b -= area * m.transpose() * d;
                vertex.quadric.b.head<2>() -= area * lambda * t;
                vertex.quadric.c += area * (d.squaredNorm() + lambda * t.squaredNorm());
            }
        }
        for (Vertex& v : vertices_) v.least = v.quadric.value(v.quadric.minimiser());
        left_ = vertices_.size();
    }

    /// Collapses the cheapest possible edge until that many vertices are left, or no edge is possible.
    void run(std::size_t target) {
        std::set<std::pair<Id, Id>> edges;
        for (const Face& f : faces_)
            for (std::size_t k = 0; k < 3; ++k) edges.insert(std::minmax(f[k], f[(k + 1) % 3]));
        for (const auto& [i, j] : edges) file(i, j);
        std::vector<std::pair<Id, Id>> refused;
        while (left_ > target) {
            if (queue_.empty()) {
                // A rejected edge may be possible now that its surroundings have changed.
                if (refused.empty() || !collapsed_) break;
                collapsed_ = false;
                for (const auto& [i, j] : refused)
                    if (alive(i) && alive(j) && shared(i, j).size() > 0) file(i, j);
                refused.clear();
                continue;
            }
            const auto [cost, edge] = *queue_.begin();
            unfile(edge.first, edge.second);
            if (!try_collapse(edge.first, edge.second, cost)) refused.push_back(edge);
        }
    }

    BaseMesh mesh() const {
        BaseMesh out;
        std::map<Id, Id> compact;
        for (Id v = 0; v < vertices_.size(); ++v) {
            if (!alive(v)) continue;
            compact[v] = static_cast<Id>(out.position.size());
            const Vec2d& p = vertices_[v].position;
            out.position.push_back(p.cast<float>());
            const Eigen::Matrix<double, 5, 1> best = vertices_[v].quadric.at(p);
            for (int c = 0; c < 3; ++c) out.feature.push_back(static_cast<float>(best[2 + c]));
        }
        for (const Face& f : faces_)
            if (f[0] != kNone) out.faces.push_back({compact[f[0]], compact[f[1]], compact[f[2]]});
        return out;
    }

  private:
    struct Sum {
        Eigen::Matrix<double, 5, 5> a = Eigen::Matrix<double, 5, 5>::Zero();
        Eigen::Matrix<double, 5, 1> b = Eigen::Matrix<double, 5, 1>::Zero();
        double c = 0;

        double value(const Eigen::Matrix<double, 5, 1>& v) const { return v.dot(a * v) + 2 * b.dot(v) + c; }
        Eigen::Matrix<double, 5, 1> minimiser() const { return a.ldlt().solve(-b); }
        // With the best colours for a position, and the best place for fixed coordinates.
        Eigen::Matrix<double, 5, 1> at(const Vec2d& p) const {
            Eigen::Matrix<double, 5, 1> v;
            v << p, a.bottomRightCorner<3, 3>().ldlt().solve(-b.tail<3>() - a.bottomLeftCorner<3, 2>() * p);
            return v;
        }
        double along(int fixed, double value) const {
            Eigen::Matrix4d rest;
            Eigen::Vector4d side;
            for (int r = 0, k = 0; r < 5; ++r) {
                if (r == fixed) continue;
                side[k] = -b[r] - a(r, fixed) * value;
                for (int col = 0, l = 0; col < 5; ++col)
                    if (col != fixed) rest(k, l++) = a(r, col);
                ++k;
            }
            return rest.ldlt().solve(side)[0];
        }
    };
    struct Vertex {
        Vec2d position;
        std::set<Id> faces;
        Sum quadric;
        double least;
    };

    bool alive(Id v) const { return !vertices_[v].faces.empty(); }
    bool side_x(Id v) const { return vertices_[v].position.x() == 0 || vertices_[v].position.x() == right_; }
    bool side_y(Id v) const { return vertices_[v].position.y() == 0 || vertices_[v].position.y() == bottom_; }
    std::set<Id> neighbors(Id v) const {
        std::set<Id> out;
        for (const Id f : vertices_[v].faces) out.insert(faces_[f].begin(), faces_[f].end());
        out.erase(v);
        return out;
    }
    std::vector<Id> shared(Id i, Id j) const {
        std::vector<Id> out;
        std::set_intersection(vertices_[i].faces.begin(), vertices_[i].faces.end(),
                              vertices_[j].faces.begin(), vertices_[j].faces.end(), std::back_inserter(out));
        return out;
    }

    // Corners stay, side vertices stay on their side; returns false if both are impossible.
    bool place(Id i, Id j, const Vec2d& wanted, Vec2d& out) const {
        out = {double{snapped(static_cast<float>(wanted.x()))},
               double{snapped(static_cast<float>(wanted.y()))}};
        const Vec2d &a = vertices_[i].position, &b = vertices_[j].position;
        if (side_x(i) && side_x(j) && a.x() != b.x()) return false;
        if (side_y(i) && side_y(j) && a.y() != b.y()) return false;
        const bool x = side_x(i) || side_x(j), y = side_y(i) || side_y(j);
        const bool corner = (side_x(i) && side_y(i)) || (side_x(j) && side_y(j));
        if (x && y && !corner) return false;
        if (x) out.x() = side_x(i) ? a.x() : b.x();
        if (y) out.y() = side_y(i) ? a.y() : b.y();
        return true;
    }

    Sum sum_of(Id i, Id j) const {
        Sum sum = vertices_[i].quadric;
        sum.a += vertices_[j].quadric.a;
        sum.b += vertices_[j].quadric.b;
        sum.c += vertices_[j].quadric.c;
        return sum;
    }
    double cost(Id i, Id j, const Sum& sum, const Vec2d& p) const {
        const double before = vertices_[i].least + vertices_[j].least;
        const double added = std::max(0.0, sum.value(sum.at(p)) - before);
        return total_ ? added + before : added;
    }
    bool best_place(Id i, Id j, const Sum& sum, Vec2d& p) const {
        if (!place(i, j, sum.minimiser().head<2>(), p)) return false;
        const bool x = side_x(i) || side_x(j), y = side_y(i) || side_y(j);
        if (x && !y) p.y() = double{snapped(static_cast<float>(sum.along(0, p.x())))};
        if (y && !x) p.x() = double{snapped(static_cast<float>(sum.along(1, p.y())))};
        return true;
    }

    void file(Id i, Id j) {
        unfile(i, j);
        const Sum sum = sum_of(i, j);
        Vec2d p;
        if (best_place(i, j, sum, p)) file_at(i, j, cost(i, j, sum, p));
    }
    void file_at(Id i, Id j, double cost) {
        const std::pair<Id, Id> edge = std::minmax(i, j);
        queue_.insert({cost, edge});
        cost_of_[edge] = cost;
    }
    void unfile(Id i, Id j) {
        const auto found = cost_of_.find(std::minmax(i, j));
        if (found == cost_of_.end()) return;
        queue_.erase({found->second, found->first});
        cost_of_.erase(found);
    }

    // Every face around the edge, except those that are removed, keeps the least shape.
    bool star_allows(Id i, Id j, const Vec2d& p) const {
        const std::vector<Id> removed = shared(i, j);
        for (const Id v : {i, j})
            for (const Id f : vertices_[v].faces) {
                if (std::find(removed.begin(), removed.end(), f) != removed.end()) continue;
                Vec2d corner[3];
                for (std::size_t k = 0; k < 3; ++k)
                    corner[k] = faces_[f][k] == v ? p : vertices_[faces_[f][k]].position;
                const double area2 =
                    signed_area2(corner[0].cast<float>(), corner[1].cast<float>(), corner[2].cast<float>());
                double longest = 0;
                for (int k = 0; k < 3; ++k)
                    longest = std::max(longest, (corner[(k + 1) % 3] - corner[k]).squaredNorm());
                if (!(area2 > 0.05 * longest)) return false;
            }
        return true;
    }

    bool try_collapse(Id i, Id j, double filed) {
        const std::vector<Id> removed = shared(i, j);
        const std::set<Id> a = neighbors(i), b = neighbors(j);
        std::vector<Id> common;
        std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
        const auto on_border = [&](Id v) { return side_x(v) || side_y(v); };
        if (on_border(i) && on_border(j) && removed.size() != 1) return false;
        if (common.size() != removed.size()) return false;
        if (a.size() + b.size() - common.size() - 2 > 12) return false;
        const Sum sum = sum_of(i, j);
        Vec2d p;
        if (!best_place(i, j, sum, p)) return false;
        if (!star_allows(i, j, p)) {
            double least = std::numeric_limits<double>::infinity();
            for (const Vec2d& wanted : {Vec2d(0.5 * (vertices_[i].position + vertices_[j].position)),
                                        vertices_[i].position, vertices_[j].position}) {
                Vec2d candidate;
                if (!place(i, j, wanted, candidate) || !star_allows(i, j, candidate)) continue;
                const double worth = cost(i, j, sum, candidate);
                if (worth < least) {
                    least = worth;
                    p = candidate;
                }
            }
            if (least == std::numeric_limits<double>::infinity()) return false;
            if (least > filed) {
                file_at(i, j, least);
                return true;
            }
        }
        for (const Id n : a) unfile(i, n);
        for (const Id n : b) unfile(j, n);
        for (const Id f : removed) {
            for (const Id v : faces_[f]) vertices_[v].faces.erase(f);
            faces_[f] = {kNone, kNone, kNone};
        }
        for (const Id f : vertices_[j].faces) {
            std::replace(faces_[f].begin(), faces_[f].end(), j, i);
            vertices_[i].faces.insert(f);
        }
        vertices_[j].faces.clear();
        vertices_[i].position = p;
        vertices_[i].quadric = sum;
        vertices_[i].least = sum.value(sum.minimiser());
        --left_;
        collapsed_ = true;
        for (const Id n : neighbors(i)) file(i, n);
        return true;
    }

    bool total_, collapsed_ = false;
    double right_, bottom_;
    std::vector<Vertex> vertices_;
    std::vector<Face> faces_;
    std::set<std::pair<double, std::pair<Id, Id>>> queue_;
    std::map<std::pair<Id, Id>, double> cost_of_;
    std::size_t left_ = 0;
};

}  // namespace imgmesh::test
