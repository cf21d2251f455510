// Each face of a base mesh as linear functions of the position: its colour and its weights.
#pragma once

#include <vector>

#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// A face (a, b, c) relative to its corner a. With d = P - a, the features are f + fx d.x + fy d.y, the
/// weight of b is ux d.x + uy d.y, and the weight of c is vx d.x + vy d.y. It takes 64 bytes, one cache line.
/// It holds the first three features, or zeros if there are fewer.
struct alignas(64) FaceField {
    float ax, ay;              ///< corner a [pixels]
    float ux, uy, vx, vy;      ///< gradients of the weights [1 / pixel]
    float f[3], fx[3], fy[3];  ///< colour at a, and its gradient
    float longest;             ///< side [pixels]

    float u(float x, float y) const { return ux * (x - ax) + uy * (y - ay); }
    float v(float x, float y) const { return vx * (x - ax) + vy * (y - ay); }
};

/// Returns one FaceField for each face; faces must not be degenerate.
std::vector<FaceField> face_fields(const BaseMesh& mesh);

/// The features from the fourth on, which do not fit into FaceField.
struct AuxiliaryFields {
    std::size_t features = 0;
    std::vector<float> values;  ///< for each face and feature: the value at corner a and its gradient in x, y

    const float* of(Id face) const { return values.data() + std::size_t{face} * features * 3; }
};
AuxiliaryFields auxiliary_fields(const BaseMesh& mesh, const std::vector<FaceField>& fields);

/// Locates the face that holds p. The search goes from `face` across the edge that p lies farthest beyond. If
/// that edge is on a boundary, it ends at the face before it.
Id locate_face(const Vec2f& p, Id face, const std::vector<FaceField>& fields,
               const std::vector<Face>& neighbors);

}  // namespace imgmesh
