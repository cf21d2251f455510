#include "tools/common/other_tool.h"

#include <algorithm>
#include <string_view>

#include "formats/files/extension.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

constexpr std::string_view kContainers[] = {".glb", ".gltf"};
constexpr std::string_view kExports[] = {".obj", ".ply", ".json", ".tscn", ".svg", ".npz"};
constexpr std::string_view kImages[] = {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".exr", ".webp", ".bmp"};

}  // namespace

std::string other_tool(const std::string& tool, const std::string& path) {
    const std::string extension = lower_extension(path);
    const auto among = [&](const auto& list) { return std::ranges::find(list, extension) != std::end(list); };
    std::string other, from = "a container";
    if (among(kExports))
        other = "imgmesh-convert";
    else if (among(kImages))
        other = "imgmesh-reconstruct";
    else if (among(kContainers))
        other = tool == "imgmesh-reconstruct" ? "imgmesh-convert" : "imgmesh-build";
    else if (extension == ".imgm")
        other = "imgmesh-encode";
    if (other.empty() || other == tool) return "";
    if (other == "imgmesh-build" || other == "imgmesh-encode") from = "an image";
    return cat("; ", other, " writes ", extension, " from ", from);
}

}  // namespace imgmesh
