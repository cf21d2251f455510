// What it costs to deform the faces of a mesh.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// A measure of a face's linear map J, with d its determinant.
struct EnergyKind {
    enum class Form {
        kRigid,     ///< |J - R|^2 with R the nearest rotation; faces may turn over
        kUntangle,  ///< (|J|^2 + d^2 + 1) / chi(d), chi the positive part of d, smoothed
        kBarrier    ///< |J|^2 + |J^-1|^2; infinite for faces that are turned over
    } form = Form::kBarrier;
    /// Of kUntangle: chi(d) = (d + sqrt(d^2 + smoothing^2)) / 2.
    double smoothing = 0;
};

/// The faces of a mesh at rest. Faces without a positive area are left out.
class FaceEnergies {
  public:
    /// is_used  whether a face counts, by its first corner
    FaceEnergies(const BaseMesh& mesh, const std::vector<bool>& is_used);

    /// Returns the sum over faces of rest area times energy; infinity if it is not finite. Adds nothing to
    /// `gradient` but overwrites it: by vertex.
    double evaluate(const EnergyKind& kind, std::span<const Vec2d> place, std::span<Vec2d> gradient) const;

    /// Returns the least determinant of a face's map; 1 without faces.
    double least_determinant(std::span<const Vec2d> place) const;

    /// Returns the largest step <= 1 such that place + s * move turns no face over for 0 <= s < step: the
    /// least positive root of each face's area, which is a quadratic polynomial in s.
    double largest_step(std::span<const Vec2d> place, std::span<const Vec2d> move) const;

    /// Calls visit(i, j, value) for each pair of corners of each face, with the integral of the product of
    /// the gradients of their hat functions: the entries of the Laplacian.
    template <typename Visit>
    void for_pairs(const Visit& visit) const {
        for (const RestFace& f : faces_) {
            const std::array<Vec2d, 3> hat = f.hats();
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t l = 0; l < 3; ++l)
                    visit(f.corner[k], f.corner[l], f.area * hat[k].dot(hat[l]));
        }
    }

    /// Calls visit(value) for each entry of each face's Hessian, made positive semidefinite: for each pair of
    /// corners, in the order of for_pairs(), the four of x and y of the first by x and y of the second.
    template <typename Visit>
    void hessian(const EnergyKind& kind, std::span<const Vec2d> place, const Visit& visit) const {
        for (const RestFace& f : faces_) {
            const std::array<Vec2d, 3> hat = f.hats();
            const std::array<std::array<double, 4>, 4> h = map_hessian(kind, f, place);
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t l = 0; l < 3; ++l)
                    for (std::size_t r = 0; r < 4; r += 2)
                        for (std::size_t c = 0; c < 4; c += 2)
                            visit(hat[k].x() * (h[r][c] * hat[l].x() + h[r][c + 1] * hat[l].y()) +
                                  hat[k].y() * (h[r + 1][c] * hat[l].x() + h[r + 1][c + 1] * hat[l].y()));
        }
    }

  private:
    struct RestFace {
        Face corner;
        double area;
        Vec2d p, q;  ///< gradients of the hat functions of the second and third corner

        std::array<Vec2d, 3> hats() const { return {-p - q, p, q}; }
    };
    static std::array<std::array<double, 4>, 4> map_hessian(const EnergyKind& kind, const RestFace& face,
                                                            std::span<const Vec2d> place);
    std::vector<RestFace> faces_;
};

}  // namespace imgmesh
