// Each face of a base mesh as two linear functions of the position: its colour and its weights.
#pragma once

#include <vector>

#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// Face (a, b, c) relative to its corner a: with d = P - a, features f + fx d.x + fy d.y, weight of b ux d.x
/// + uy d.y, weight of c vx d.x + vy d.y. 64 bytes: one cache line. Of the features the first three, zero
/// where there are fewer.
struct alignas(64) FaceField {
    float ax, ay;              ///< corner a [pixels]
    float ux, uy, vx, vy;      ///< gradients of the weights [1 / pixel]
    float f[3], fx[3], fy[3];  ///< colour at a, and its gradient

    static constexpr int kFloats = 15;
    float u(float x, float y) const { return ux * (x - ax) + uy * (y - ay); }
    float v(float x, float y) const { return vx * (x - ax) + vy * (y - ay); }
};

/// One FaceField a face; faces must not be degenerate.
std::vector<FaceField> face_fields(const BaseMesh& mesh);

/// The features from the fourth on, which FaceField has no room for.
struct AuxiliaryFields {
    std::size_t features = 0;
    std::vector<float> values;  ///< for each face and feature the value at corner a, and its gradient in x, y

    const float* of(Id face) const { return values.data() + std::size_t{face} * features * 3; }
};
AuxiliaryFields auxiliary_fields(const BaseMesh& mesh, const std::vector<FaceField>& fields);

/// The face that holds p, walking from `face` across the edge that p lies farthest beyond; where that is the
/// border, the face before it.
Id locate_face(const Vec2f& p, Id face, const std::vector<FaceField>& fields,
               const std::vector<Face>& neighbors);

}  // namespace imgmesh
