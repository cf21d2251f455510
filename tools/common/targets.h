// What was asked for in numbers and was not reached: told in the text and in the report, or refused.
#pragma once

#include <string>
#include <vector>

#include "libcore/base/error.h"
#include "tools/common/tool_main.h"

namespace imgmesh {

/// Adds --strict.
void add_strict_option(CLI::App& app, bool& strict);

/// An Error(kUnsupported) about `input` that tells reports what was not reached.
class MissedTargets : public Error {
  public:
    MissedTargets(const std::string& input, std::vector<std::string> missed);

    const std::vector<std::string>& missed() const { return missed_; }

  private:
    std::vector<std::string> missed_;
};

/// Appends a warning about `input` for each line of `missed`. Throws MissedTargets instead if `strict`, so
/// that nothing is written.
void tell_missed(const std::string& input, const std::vector<std::string>& missed, bool strict,
                 std::vector<std::string>& warnings);

/// Returns the members "target_reached" and, if that is false, "reason".
Report target_report(const std::vector<std::string>& missed);

}  // namespace imgmesh
