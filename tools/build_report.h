// What imgmesh-build reports about the containers that it made.
#pragma once

#include <iosfwd>
#include <string>

#include "formats/container/container.h"
#include "libcore/image/image.h"
#include "libcore/pipeline/build.h"
#include "tools/common/tool_main.h"

namespace imgmesh {

/// Wall time of the parts that the library does not measure [s].
struct FileSeconds {
    double read = 0, write = 0, all = 0;
};

/// Returns an image's part of the report. written: what was written; alpha: "none", "kept", "cut" or
/// "ignored"; values: those of --values.
Report image_report(const Image& image, const std::string& alpha, bool values, const BuildReport& built,
                    const Container& written, const FileSeconds& seconds);

/// Prints an image's part of the report.
void print_build(const Report& report, std::ostream& out);
/// The same in a few words.
std::string build_line(const Report& report);

}  // namespace imgmesh
