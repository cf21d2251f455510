// What checks of a container throw.
#pragma once

#include <cstddef>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "formats/findings/finding_codes.h"
#include "formats/findings/place.h"

namespace imgmesh {

/// One of kFindings, by its code; any other does not compile.
struct FindingCode {
    std::size_t index = 0;
    consteval FindingCode(const char* code) {
        while (index < std::size(kFindings) && kFindings[index].code != code) ++index;
        if (index == std::size(kFindings)) throw "not in kFindings";
    }
};

/// What the codecs throw: a code, one line about what was found, without the file's name, which they do not
/// know, and where. read_container turns it into an Error.
class FindingError : public std::runtime_error {
  public:
    FindingError(FindingCode code, const std::string& text, Place place = {})
        : std::runtime_error(text), code_(code), place_(std::move(place)) {}
    FindingCode finding() const { return code_; }
    std::string_view code() const { return kFindings[code_.index].code; }
    ErrorKind error_kind() const { return kFindings[code_.index].error; }
    const Place& place() const { return place_; }

  private:
    FindingCode code_;
    Place place_;
};

[[noreturn]] inline void refuse(FindingCode code, const std::string& text, Place place = {}) {
    throw FindingError(code, text, std::move(place));
}

}  // namespace imgmesh
