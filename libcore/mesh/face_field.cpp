#include "libcore/mesh/face_field.h"

#include <algorithm>
#include <cmath>

#include "libcore/base/parallel.h"

namespace imgmesh {
namespace {

constexpr std::size_t kSpareSteps =
    8;  // a mesh of few faces has about as many steps as faces; none is missed

}  // namespace

std::vector<FaceField> face_fields(const BaseMesh& mesh) {
    std::vector<FaceField> fields(mesh.faces.size(), FaceField{});
    constexpr int kGrainFaces = 4096;  // 256 kB of fields a block
    parallel_blocks(0, as_int(fields.size()), kGrainFaces, [&](int first, int last) {
        for (std::size_t i = as_index(first); i < as_index(last); ++i) {
            const auto [a, b, c] = mesh.faces[i];
            FaceField& field = fields[i];
            const Vec2f &pa = mesh.position[a], ab = mesh.position[b] - pa, ac = mesh.position[c] - pa;
            const double det = double(ab.x()) * ac.y() - double(ab.y()) * ac.x();
            field.longest =
                std::sqrt(std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()}));
            field.ax = pa.x();
            field.ay = pa.y();
            field.ux = static_cast<float>(ac.y() / det);
            field.uy = static_cast<float>(-ac.x() / det);
            field.vx = static_cast<float>(-ab.y() / det);
            field.vy = static_cast<float>(ab.x() / det);
            for (int k = 0; k < std::min(3, mesh.channels); ++k) {
                const float fa = mesh.feature_of(a)[k], fb = mesh.feature_of(b)[k],
                            fc = mesh.feature_of(c)[k];
                field.f[k] = fa;
                field.fx[k] = field.ux * (fb - fa) + field.vx * (fc - fa);
                field.fy[k] = field.uy * (fb - fa) + field.vy * (fc - fa);
            }
        }
    });
    return fields;
}

AuxiliaryFields auxiliary_fields(const BaseMesh& mesh, const std::vector<FaceField>& fields) {
    AuxiliaryFields auxiliary{as_index(std::max(0, mesh.channels - 3)), {}};
    auxiliary.values.reserve(fields.size() * auxiliary.features * 3);
    for (std::size_t f = 0; auxiliary.features > 0 && f < fields.size(); ++f) {
        const auto [a, b, c] = mesh.faces[f];
        const FaceField& field = fields[f];
        for (int k = 3; k < mesh.channels; ++k) {
            const float fa = mesh.feature_of(a)[k], ab = mesh.feature_of(b)[k] - fa,
                        ac = mesh.feature_of(c)[k] - fa;
            for (const float value : {fa, field.ux * ab + field.vx * ac, field.uy * ab + field.vy * ac})
                auxiliary.values.push_back(value);
        }
    }
    return auxiliary;
}

Id locate_face(const Vec2f& p, Id face, const std::vector<FaceField>& fields,
               const std::vector<Face>& neighbors) {
    // The bound only guards against rounding that leads in circles: in a convex domain the search arrives.
    for (std::size_t step = 0; step < fields.size() + kSpareSteps; ++step) {
        const FaceField& field = fields[face];
        const float u = field.u(p.x(), p.y()), v = field.v(p.x(), p.y()), w = 1 - u - v;
        const float least = std::min({u, v, w});
        if (least >= 0) return face;
        const Id next = neighbors[face][least == w ? 0 : least == u ? 1 : 2];
        if (next == kNone) return face;
        face = next;
    }
    return face;
}

}  // namespace imgmesh
