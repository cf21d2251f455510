// One progress for parallel work.
#pragma once

#include <mutex>
#include <string_view>
#include <vector>

#include "libcore/base/progress.h"

namespace imgmesh {

/// The share of all parts that is done, from the shares of each part, which several threads report.
class JointProgress {
  public:
    JointProgress(std::size_t count, const Progress& progress)
        : fractions_(count, 0.0), progress_(progress) {}

    void show(std::size_t index, double fraction, std::string_view stage) {
        const std::lock_guard lock(mutex_);
        sum_ += fraction - fractions_[index];
        fractions_[index] = fraction;
        progress_(sum_ / static_cast<double>(fractions_.size()), stage);
    }

  private:
    std::mutex mutex_;
    std::vector<double> fractions_;
    double sum_ = 0;
    const Progress& progress_;
};

}  // namespace imgmesh
