// imgmesh reports every bad argument and every bad file by an exception of class Error.
#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace imgmesh {

/// What kind of thing is wrong. The tools give each kind an exit code of its own.
enum class ErrorKind {
    kInternal,     ///< our own mistake, or a library that failed for no reason of the user's
    kBadArgument,  ///< a parameter is out of range, or parameters contradict each other
    kIo,           ///< a file cannot be read or written
    kBadFile,      ///< a file's content is not what it must be
    kUnsupported,  ///< a valid request or file that imgmesh does not support
};

/// Thrown for a bad argument or a bad file. The text names the file or parameter, what was found and what was
/// expected, in one line without a full stop. Our own mistakes are assertions, not Errors.
class Error : public std::runtime_error {
  public:
    Error(ErrorKind kind, const std::string& text) : std::runtime_error(text), kind_(kind) {}
    ErrorKind kind() const { return kind_; }

  private:
    ErrorKind kind_;
};

/// Concatenates everything that can be streamed into one string; for messages.
template <typename... Parts>
std::string cat(const Parts&... parts) {
    std::ostringstream out;
    (out << ... << parts);
    return out.str();
}

}  // namespace imgmesh
