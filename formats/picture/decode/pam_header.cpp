#include "formats/picture/decode/pam_header.h"

#include <algorithm>
#include <charconv>
#include <string_view>

#include "formats/files/one_line.h"
#include "libcore/base/error.h"

namespace imgmesh {

PamHeader pam_header(const std::string& path, PnmText& text) {
    PamHeader header;
    for (;;) {
        const std::string_view line = text.line();
        if (line == "ENDHDR") return header;
        if (line.empty() || line[0] == '#') continue;
        const std::size_t gap = std::min(line.find_first_of(" \t"), line.size());
        const std::string_view name = line.substr(0, gap);
        const std::size_t start = std::min(line.find_first_not_of(" \t", gap), line.size());
        const std::string_view value = line.substr(start);
        std::int64_t* const number = name == "WIDTH"    ? &header.width
                                     : name == "HEIGHT" ? &header.height
                                     : name == "DEPTH"  ? &header.depth
                                     : name == "MAXVAL" ? &header.largest
                                                        : nullptr;
        if (name == "TUPLTYPE") {
            header.type += (header.type.empty() ? "" : " ") + std::string(value);
        } else if (!number) {
            throw Error(ErrorKind::kBadFile,
                        cat(path, ": the PAM's header has a line ", printable(std::string(name)),
                            ", expected WIDTH, HEIGHT, DEPTH, MAXVAL, TUPLTYPE or ENDHDR"));
        } else if (const auto [end, failure] =
                       std::from_chars(value.data(), value.data() + value.size(), *number);
                   failure != std::errc() || end != value.data() + value.size() || *number < 1) {
            throw Error(ErrorKind::kBadFile, cat(path, ": the PAM's ", name, " is no number above 0"));
        }
    }
}

}  // namespace imgmesh
