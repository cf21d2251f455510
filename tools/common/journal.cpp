#include "tools/common/journal.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <span>
#include <string_view>

#include "formats/container/sidecar_file.h"
#include "formats/files/extension.h"
#include "formats/files/sha256.h"
#include "libcore/base/error.h"

namespace fs = std::filesystem;

namespace imgmesh {
namespace {

constexpr int kVersion = 2;
// What no journal of ours reaches: a line takes 2 to 5 kB.
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30;
constexpr std::size_t kMostLine = std::size_t{1} << 20;
constexpr int kMostDepth = 16;

// Ends a line, with the SHA-256 of all before it: what was edited or damaged is not believed.
constexpr std::string_view kSeal = ",\"sha256\":\"", kEnd = "\"}";
constexpr std::size_t kHash = 64;

std::span<const std::uint8_t> bytes_of(std::string_view text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::string sealed(std::string_view content) {
    return cat(content, kSeal, sha256_hex(bytes_of(content)), kEnd);
}

bool is_sealed(std::string_view line) {
    constexpr std::size_t kTail = kSeal.size() + kHash + kEnd.size();
    return line.size() > kTail && sealed(line.substr(0, line.size() - kTail)) == line;
}

// Returns whether a report has what the code relies on. Whoever seals a line can still write any.
bool is_report(const Report& report) {
    if (!report.is_object() || report.contains("inputs")) return false;
    const auto fits = [&](const char* member, auto is) {
        return report.contains(member) && std::invoke(is, report[member]);
    };
    if (!fits("parameters", &Report::is_object) || !fits("input", &Report::is_string)) return false;
    if (report.contains("output") && !report["output"].is_string()) return false;
    if (report.contains("target_reached") && !report["target_reached"].is_boolean()) return false;
    const auto is_texts = [&](const char* member) {
        const Report& list = report[member];
        return list.is_array() && std::ranges::all_of(list, &Report::is_string);
    };
    for (const char* member : {"warnings", "outputs"})
        if (report.contains(member) && !is_texts(member)) return false;
    return true;
}

// Returns the line's object, or null.
Report parse_entry(const std::string& line) {
    if (!is_sealed(line)) return nullptr;
    bool too_deep = false;
    const auto watch = [&](int depth, Report::parse_event_t, Report&) {
        too_deep = too_deep || depth > kMostDepth;
        return !too_deep;
    };
    Report entry = Report::parse(line, watch, /*allow_exceptions=*/false);
    if (too_deep || !entry.is_object()) return nullptr;
    const auto is_text = [&](const char* key) { return entry.contains(key) && entry[key].is_string(); };
    if (entry.value("journal", Report()) != kVersion || !is_text("key") || !is_text("output")) return nullptr;
    if (!entry.contains("report") || !is_report(entry["report"])) return nullptr;
    return entry;
}

Report facts_of(const std::vector<std::string>& files) {
    Report facts = Report::array();
    for (const std::string& file : files) {
        std::error_code error;  // of a file that is not there, which has no hash
        const std::uint64_t bytes = fs::file_size(file, error);
        facts.push_back({{"bytes", error ? 0 : bytes}, {"sha256", file_sha256_hex(file)}});
    }
    return facts;
}

// Adds the files that a report lists beside the output `first` and that stand in the same folder: whoever
// wrote the report may not point elsewhere.
void add_beside(const Report& report, const std::string& first, std::vector<std::string>& files) {
    if (!report.contains("outputs")) return;
    for (const Report& path : report["outputs"]) {
        const fs::path name = fs::path(path.get<std::string>()).filename();
        const fs::path file = fs::path(first).parent_path() / name;
        if (name != fs::path(first).filename()) files.push_back(file.string());
    }
}

// The first file that a job writes.
std::string written_name(const Job& job) {
    if (!job.output.empty()) return job.output;
    for (const std::string& side : job.sides)
        if (!side.empty()) return side;
    return "";
}

// Reads the next line, or the rest of it where it is too long, and returns whether there was one.
bool next_line(std::istream& in, std::string& line, bool& whole) {
    line.clear();
    whole = true;
    int c = 0;
    bool any = false;
    while ((c = in.rdbuf()->sbumpc()) != std::char_traits<char>::eof()) {
        any = true;
        if (c == '\n') return true;
        if (line.size() < kMostLine)
            line += static_cast<char>(c);
        else
            whole = false;
    }
    return any;
}

}  // namespace

Journal::Journal(const std::string& folder) : path_((fs::path(folder) / kName).string()) {}

void Journal::read(const std::set<std::string>& outputs) {
    struct stat info = {};
    if (::lstat(path_.c_str(), &info) != 0 || !S_ISREG(info.st_mode)) return;
    if (static_cast<std::uint64_t>(info.st_size) >= kMostBytes) {
        trouble_ = cat(path_, ": has 1 GiB or more and is not used, so nothing is skipped; remove it");
        return;
    }
    std::ifstream in(path_, std::ios::binary);
    std::string line;
    for (bool whole = true; in && next_line(in, line, whole);) {
        const Report entry = whole ? parse_entry(line) : Report();
        if (entry.is_null()) continue;
        const std::string output = entry["output"].get<std::string>();
        if (outputs.count(output)) line_of_[output] = line;
    }
}

Report Journal::find(const std::string& output, const std::string& key,
                     const std::vector<std::string>& files) const {
    const auto line = line_of_.find(output);
    if (line == line_of_.end()) return nullptr;
    Report entry = parse_entry(line->second);
    if (entry["key"] != key) return nullptr;
    std::vector<std::string> all = files;
    add_beside(entry["report"], files.front(), all);
    // Sizes first: files that were cut short need not be read.
    const Report known = entry.contains("files") ? entry["files"] : Report();
    if (!known.is_array() || known.size() != all.size()) return nullptr;
    for (std::size_t i = 0; i < all.size(); ++i) {
        std::error_code error;
        const std::uint64_t bytes = fs::file_size(all[i], error);
        if (error || !known[i].is_object() || !known[i].contains("bytes") || known[i]["bytes"] != bytes)
            return nullptr;
    }
    if (facts_of(all) != known) return nullptr;
    return std::move(entry["report"]);
}

void Journal::add(const std::string& output, const std::string& key, const std::vector<std::string>& files,
                  const Report& report) {
    std::vector<std::string> all = files;
    add_beside(report, files.front(), all);
    const Report entry = {{"journal", kVersion},
                          {"key", key},
                          {"output", output},
                          {"files", facts_of(all)},
                          {"report", report}};
    std::string content = entry.dump(-1, ' ', false, Report::error_handler_t::replace);
    content.pop_back();  // the brace
    std::string line = sealed(content) + '\n';
    const std::lock_guard lock(mutex_);
    const int fd =
        ::open(path_.c_str(), O_RDWR | O_APPEND | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
    struct stat info = {};
    bool good = fd >= 0 && ::fstat(fd, &info) == 0 && S_ISREG(info.st_mode);
    if (good) {
        ::flock(fd, LOCK_EX);  // where a file system has none, the append of one write() has to do
        // A killed run may have left a part of a line.
        char last = '\n';
        if (::fstat(fd, &info) == 0 && info.st_size > 0 && ::pread(fd, &last, 1, info.st_size - 1) == 1 &&
            last != '\n')
            line.insert(line.begin(), '\n');
        good = ::write(fd, line.data(), line.size()) == static_cast<ssize_t>(line.size()) &&
               ::fdatasync(fd) == 0;
    } else if (fd >= 0) {
        errno = EINVAL;
    }
    const int error = errno;
    if (fd >= 0) ::close(fd);
    if (!good) throw Error(ErrorKind::kIo, cat(path_, ": cannot write: ", std::strerror(error)));
}

std::string journal_key(const Tool& tool, const std::string& generator, const Job& job,
                        const Report& parameters, const std::map<std::string, std::string>& hashes) {
    const auto input = hashes.find(job.input);
    if (input == hashes.end()) return "";
    Report parts = {{"generator", generator}, {"parameters", parameters}, {"input", input->second}};
    if (lower_extension(job.input) == ".gltf") {
        // Only a container's own files are known by their names.
        const std::vector<std::string> files = sidecars_of(job.input);
        constexpr std::size_t kBoth = 2;
        if (files.size() != kBoth) return "";
        parts["files"] = facts_of(files);
    }
    for (std::size_t i = 0; i < job.sides.size(); ++i)
        if (!job.sides[i].empty()) parts["sides"][tool.sides[i].option] = lower_extension(job.sides[i]);
    return sha256_hex(bytes_of(parts.dump(-1, ' ', false, Report::error_handler_t::replace)));
}

std::string journal_name(const Job& job) {
    return fs::path(written_name(job)).filename().string();
}

std::string journal_folder(const Job& job) {
    return fs::path(written_name(job)).parent_path().string();
}

std::vector<std::string> written_files(const Job& job) {
    std::vector<std::string> files;
    if (!job.output.empty()) files.push_back(job.output);
    if (lower_extension(job.output) == ".gltf")
        for (const std::string& file : sidecars_of(job.output)) files.push_back(file);
    for (const std::string& side : job.sides)
        if (!side.empty()) files.push_back(side);
    return files;
}

}  // namespace imgmesh
