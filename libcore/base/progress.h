// How long work reports its progress.
#pragma once

#include <functional>
#include <string_view>

namespace imgmesh {

/// Called from time to time on the thread that started the work. `fraction` in [0, 1] never falls; the word
/// names the current stage ("collapse"). May be empty. What it throws ends the work.
using Progress = std::function<void(double fraction, std::string_view stage)>;

}  // namespace imgmesh
