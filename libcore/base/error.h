// The one way in which imgmesh reports a bad argument or a bad file: an exception of class Error.
#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace imgmesh {

/// Exit codes of every tool. The comments are printed by `--help`.
enum class ErrorCode : int {
    kOk = 0,           ///< done
    kInternal = 1,     ///< internal error
    kUsage = 2,        ///< wrong use of the command line
    kIo = 3,           ///< cannot read or write
    kBadFile = 4,      ///< a file's content is not what it must be
    kUnsupported = 5,  ///< a valid request or file that imgmesh does not support
    kDifferent = 7,    ///< compared, and different
};

/// Thrown for a bad argument or a bad file. The text names the file or option, what was found and what was
/// expected, in one line without a full stop. Our own mistakes are assertions, not Errors.
class Error : public std::runtime_error {
  public:
    Error(ErrorCode code, const std::string& text) : std::runtime_error(text), code_(code) {}
    ErrorCode code() const { return code_; }

  private:
    ErrorCode code_;
};

/// Concatenates everything that streams into one string; for messages.
template <typename... Parts>
std::string cat(const Parts&... parts) {
    std::ostringstream out;
    (out << ... << parts);
    return out.str();
}

}  // namespace imgmesh
