#include "formats/findings/findings.h"

#include "formats/files/one_line.h"
#include "libcore/base/error.h"

namespace imgmesh {

std::size_t Findings::add(FindingCode code, const std::string& text, Place place) {
    const Finding& finding = kFindings[code.index];
    if (!collects_) {
        if (finding.severity == Severity::kError) throw FindingError(code, text, std::move(place));
        return 0;
    }
    if (!place.pointer.starts_with('/')) {
        std::string pointer = base_;
        if (!place.pointer.empty()) pointer += '/' + place.pointer;
        place.pointer = std::move(pointer);
    }
    errors_ += finding.severity == Severity::kError;
    // Names from the file are quoted unchanged; the message stays one line.
    issues_.push_back({&finding, printable(text, ' '), std::move(place), 1});
    return issues_.size() - 1;
}

}  // namespace imgmesh
