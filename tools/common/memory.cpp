#include "tools/common/memory.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <string_view>

#include "libcore/base/error.h"
#include "tools/common/text.h"

namespace imgmesh {
namespace {

// While a container is read, each level takes this beside its map [bytes a pixel]; measured.
constexpr double kReadBytes = 8;

constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();

// The first number in a file, or no limit: "max" stands in files of control groups.
std::uint64_t number_in(const std::string& path) {
    std::ifstream file(path);
    std::uint64_t number = 0;
    return file >> number ? number : kNoLimit;
}

std::uint64_t machine_memory() {
    std::ifstream file("/proc/meminfo");
    std::string name;
    std::uint64_t kilobytes = 0;
    return file >> name >> kilobytes && name == "MemTotal:" ? kilobytes * 1024 : kNoLimit;
}

// A group's limit holds for the groups inside it. Containers often see their own group as the root.
std::uint64_t group_memory() {
    std::uint64_t least = std::min(number_in("/sys/fs/cgroup/memory.max"),
                                   number_in("/sys/fs/cgroup/memory/memory.limit_in_bytes"));
    std::ifstream groups("/proc/self/cgroup");
    for (std::string line; std::getline(groups, line);) {
        const bool second = line.starts_with("0::");  // version 2; in version 1 each controller has a line
        const std::size_t memory = line.find(":memory:");
        if (!second && memory == std::string::npos) continue;
        const std::string root = second ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory";
        const std::string file = second ? "/memory.max" : "/memory.limit_in_bytes";
        std::string group = line.substr(second ? 3 : memory + std::string_view(":memory:").size());
        while (group.size() > 1) {
            least = std::min(least, number_in(root + group + file));
            group.erase(group.rfind('/'));
        }
    }
    return least;
}

}  // namespace

std::uint64_t usual_max_memory() {
    const std::uint64_t memory = std::min(machine_memory(), group_memory());
    return memory == kNoLimit ? kNoLimit : memory / 4 * 3;
}

std::uint64_t parse_memory(const std::string& name, const std::string& text) {
    constexpr std::string_view kUnits = "kMGT";
    constexpr double kLeast = 1, kMost = 1e18;
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
    if (unit.size() == 1)
        if (const std::size_t power = kUnits.find(unit[0]); power != std::string_view::npos) {
            value *= std::pow(1000.0, static_cast<double>(power + 1));
            unit = {};
        }
    if (error != std::errc() || !unit.empty() || !(value >= kLeast && value <= kMost))
        throw Error(
            ErrorKind::kBadArgument,
            cat(name, " '", shortened(text), "': expected bytes, or a number with k, M, G or T, as in 2G"));
    return static_cast<std::uint64_t>(value);
}

double container_memory(const MeshImage& mesh_image, double work) {
    const SourceInfo& source = mesh_image.source;
    const double pixels = static_cast<double>(source.width) * source.height;
    double bytes = static_cast<double>(mesh_image.visits.size() * sizeof(Id)), reading = 0;
    for (const Level& level : mesh_image.levels) {
        reading += pixels * kReadBytes;
        bytes += pixels * sizeof(PixelCoord) + static_cast<double>(level.mesh.faces.size() * sizeof(Face));
        bytes += static_cast<double>(level.mesh.position.size() * sizeof(Vec2f) +
                                     level.mesh.feature.size() * sizeof(float));
    }
    return kProgramMemory + bytes + std::max(reading, work);
}

void check_memory(const std::string& what, double bytes, std::uint64_t most) {
    if (bytes <= static_cast<double>(most)) return;
    const double shown = std::min(bytes, 1e18);
    throw Error(ErrorKind::kBadFile,
                cat(what, " takes about ", format_bytes(static_cast<std::uint64_t>(shown)),
                    " of memory, --max-memory is ", format_bytes(most)));
}

void JobMemory::take(const std::string& what, double bytes) {
    check_memory(what, bytes, most_);
    // Given back first: who holds a share while waiting for more may wait for another who does the same.
    share_.reset();
    bytes_ += bytes;
    share_.emplace(*gate_, bytes_);
}

void JobMemory::take_for(const std::string& path, const MeshImage& mesh_image, double bytes_a_pixel) {
    const SourceInfo& source = mesh_image.source;
    const double pixels = static_cast<double>(source.width) * source.height;
    take(cat(path, ": an image of ", source.width, "x", source.height, " pixels"),
         container_memory(mesh_image, pixels * bytes_a_pixel));
}

void MemoryGate::enter(double bytes) {
    std::unique_lock lock(mutex_);
    left_.wait(lock, [&] { return jobs_ == 0 || taken_ + bytes <= most_; });
    taken_ += bytes;
    ++jobs_;
}

void MemoryGate::leave(double bytes) {
    {
        const std::lock_guard lock(mutex_);
        taken_ -= bytes;
        --jobs_;
    }
    left_.notify_all();
}

}  // namespace imgmesh
