#include "formats/findings/findings.h"

#include <algorithm>

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
    std::string line = text;
    std::replace_if(
        line.begin(), line.end(), [](unsigned char c) { return c < 32 || c == 127; }, ' ');
    issues_.push_back({&finding, std::move(line), std::move(place), 1});
    return issues_.size() - 1;
}

}  // namespace imgmesh
