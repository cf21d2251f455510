#include "formats/files/extension.h"

#include <filesystem>

namespace imgmesh {

std::string lower_extension(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    // Not tolower(), which depends on the locale.
    for (char& c : extension)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return extension;
}

}  // namespace imgmesh
