// The product of two vectors as the same number on any machine.
#pragma once

#include "libcore/base/types.h"

namespace imgmesh {

/// Returns the scalar product, summed from left to right. Eigen's dot() and squaredNorm() of doubles sum in
/// another order where there are vector instructions for two of them (x86-64) than where there are none
/// (WebAssembly), and then decide otherwise between equals.
template <int N>
double dot(const Eigen::Matrix<double, N, 1>& a, const Eigen::Matrix<double, N, 1>& b) {
    double sum = a[0] * b[0];
    for (int i = 1; i < N; ++i) sum += a[i] * b[i];
    return sum;
}

}  // namespace imgmesh
