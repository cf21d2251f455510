#include "web/engine/file_folder.h"

#include <algorithm>
#include <filesystem>

#include "formats/files/one_line.h"
#include "libcore/base/error.h"

namespace fs = std::filesystem;

namespace imgmesh::web {
namespace {

using emscripten::val;

constexpr const char* kFolder = "/files";

}  // namespace

void check_file_name(const std::string& name) {
    constexpr std::size_t kMaxName = 255;
    const bool bad =
        name.empty() || name == "." || name == ".." || name.size() > kMaxName ||
        std::ranges::any_of(name, [](unsigned char c) { return c < 32 || c == '/' || c == 127; });
    if (bad)
        throw Error(ErrorKind::kBadArgument,
                    cat("name '", printable(name), "': expected a file's name without its folder"));
}

FileFolder::FileFolder() {
    fs::current_path("/");  // an error of JavaScript's own may have kept the last one from its end
    fs::remove_all(kFolder);
    fs::create_directory(kFolder);
    fs::current_path(kFolder);
}

FileFolder::~FileFolder() {
    std::error_code error;
    fs::current_path("/", error);
    fs::remove_all(kFolder, error);
}

void FileFolder::add(const std::string& name, const val& bytes) {
    check_file_name(name);
    val::module_property("FS").call<void>("writeFile", name, bytes);
}

val FileFolder::bytes(const std::string& name) const {
    return val::module_property("FS").call<val>("readFile", name);
}

val FileFolder::files(const std::vector<std::string>& names) const {
    val files = val::array();
    for (const std::string& name : names) {
        val file = val::object();
        file.set("name", name);
        file.set("bytes", bytes(name));
        files.call<void>("push", file);
    }
    return files;
}

val save_exr_parts(const std::vector<NamedImage>& parts) {
    const FileFolder folder;
    write_exr_parts("parts.exr", parts, true);
    return folder.bytes("parts.exr");
}

}  // namespace imgmesh::web
