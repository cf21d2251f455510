#include "tools/common/output.h"

#include <sys/stat.h>

#include <filesystem>
#include <map>
#include <set>
#include <system_error>
#include <utility>

#include "formats/files/atomic_file.h"
#include "formats/files/stream_file.h"
#include "libcore/base/error.h"

namespace fs = std::filesystem;

namespace imgmesh {

void check_output(const std::string& path, bool overwrite) {
    if (stream_descriptor(path) >= 0) return;
    std::error_code error;
    const fs::path parent = fs::path(path).parent_path();
    if (!parent.empty() && !fs::is_directory(parent, error))
        throw Error(ErrorKind::kIo, cat(path, ": cannot write: there is no folder ", parent.string()));
    if (fs::exists(path, error) && !fs::is_regular_file(path, error))
        throw Error(ErrorKind::kIo, cat(path, ": cannot write: is not a regular file"));
    if (!overwrite && fs::exists(fs::symlink_status(path, error)))
        throw Error(ErrorKind::kIo, cat(path, ": exists, and is not overwritten"));
}

void check_distinct(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs) {
    struct stat info = {};
    std::map<std::pair<dev_t, ino_t>, std::string> input_of;
    for (const std::string& input : inputs)
        if (::stat(input.c_str(), &info) == 0) input_of.emplace(std::pair(info.st_dev, info.st_ino), input);
    for (const std::string& output : outputs) {
        if (::stat(output.c_str(), &info) != 0) continue;  // what does not exist is no conflict
        const auto same = input_of.find({info.st_dev, info.st_ino});
        if (same != input_of.end())
            throw Error(ErrorKind::kBadArgument, cat(output, ": would replace the input ", same->second));
    }
}

void check_separate(const std::vector<std::string>& outputs) {
    std::set<fs::path> seen;
    for (const std::string& output : outputs) {
        std::error_code error;  // of paths that cannot be resolved; writing reports the reason
        const fs::path path = fs::weakly_canonical(fs::absolute(output), error);
        if (!error && !seen.insert(path).second)
            throw Error(ErrorKind::kBadArgument, cat(output, ": is named for two outputs"));
    }
}

std::uint64_t size_of_files(const std::vector<std::string>& files) {
    std::uint64_t bytes = 0;
    for (const std::string& file : files) bytes += output_bytes(file);
    return bytes;
}

void write_text(const std::string& path, const std::string& text, bool overwrite) {
    AtomicFile file(path, overwrite);
    file.write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    file.commit();
}

std::uint64_t output_bytes(const std::string& path) {
    return fs::file_size(system_path(path));
}

void make_folder(const std::string& path) {
    std::error_code error;
    fs::create_directories(path, error);
    if (error) throw Error(ErrorKind::kIo, cat(path, ": cannot make the folder: ", error.message()));
    if (!fs::is_directory(path)) throw Error(ErrorKind::kIo, cat(path, ": is not a folder"));
}

}  // namespace imgmesh
