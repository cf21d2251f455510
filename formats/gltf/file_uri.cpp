#include "formats/gltf/file_uri.h"

#include <algorithm>
#include <string_view>

#include "formats/findings/finding_error.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

constexpr std::string_view kHexDigits = "0123456789ABCDEF";

bool is_bare_name(std::string_view name) {
    return !name.empty() && name != "." && name != ".." && std::none_of(name.begin(), name.end(), [](char c) {
        return c == '/' || c == '\\' || static_cast<unsigned char>(c) < 32 || c == 127;
    });
}

bool is_unreserved(char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '.' || c == '_' || c == '~';
}

int hex_value(char c) {
    const std::size_t value = kHexDigits.find(c >= 'a' && c <= 'f' ? static_cast<char>(c - 'a' + 'A') : c);
    return value == std::string_view::npos ? -1 : static_cast<int>(value);
}

}  // namespace

std::string uri_from_name(const std::string& name) {
    if (!is_bare_name(name))
        throw Error(ErrorKind::kBadArgument, cat(name, ": a container's files cannot have this name"));
    std::string uri;
    for (const char c : name) {
        if (is_unreserved(c)) {
            uri += c;
        } else {
            const auto byte = static_cast<unsigned char>(c);
            uri += {'%', kHexDigits[byte >> 4], kHexDigits[byte & 15]};
        }
    }
    return uri;
}

std::string name_from_uri(const std::string& uri) {
    const auto fail = [&] {
        constexpr std::size_t kShown = 60;  // a data URI holds a whole file
        refuse("uri.name", uri.size() <= kShown
                               ? cat("the URI \"", uri, "\" is not the bare name of a file beside")
                               : cat("a URI of ", uri.size(), " bytes, \"", uri.substr(0, kShown),
                                     "...\", is not the bare name of a file beside"));
    };
    std::string name;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] == ':' || uri[i] == '?' || uri[i] == '#') fail();
        if (uri[i] != '%') {
            name += uri[i];
            continue;
        }
        const int high = i + 1 < uri.size() ? hex_value(uri[i + 1]) : -1;
        const int low = i + 2 < uri.size() ? hex_value(uri[i + 2]) : -1;
        if (high < 0 || low < 0) fail();
        name += static_cast<char>(high * 16 + low);
        i += 2;
    }
    if (!is_bare_name(name)) fail();
    return name;
}

}  // namespace imgmesh
