// How long work tells where it stands.
#pragma once

#include <functional>
#include <string_view>

namespace imgmesh {

/// Called now and then, always from the thread that started the work: `fraction` of the whole in [0, 1],
/// never falling, and a word for the current stage ("collapse"). May be empty. Must not throw.
using Progress = std::function<void(double fraction, std::string_view stage)>;

}  // namespace imgmesh
