#include "tools/common/jobs.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <string_view>

#include "formats/container/container.h"
#include "formats/files/extension.h"
#include "formats/tileset/tile_set_files.h"
#include "libcore/base/error.h"
#include "tools/common/output.h"

namespace fs = std::filesystem;

namespace imgmesh {
namespace {

// A folder, as a tile set is, has no extension, and may be given as in "set/" or ".".
std::string name_of_input(const std::string& input) {
    std::error_code error;
    if (!fs::is_directory(input, error)) return fs::path(input).stem().string();
    const fs::path folder = fs::weakly_canonical(input, error);
    return (folder.has_filename() ? folder : folder.parent_path()).filename().string();
}

std::string in_folder(const std::string& folder, const std::string& input, const std::string& extension) {
    return fs::path(folder) / (name_of_input(input) + "." + extension);
}

std::string needs_folder(const std::string& option, const std::string& value, std::size_t count) {
    return cat(option, " ", value, ": ", count, " files need a folder, whose name ends with /");
}

// The file of an option for `input`.
std::string side_of(const SideFile& side, const std::string& type, const std::string& input,
                    std::size_t count) {
    const std::string& value = *side.value;
    if (value.empty()) return value;
    const bool other = std::ranges::find(side.others, type) != side.others.end();
    if (is_folder(value)) return in_folder(value, input, other ? type : side.extension);
    if (count > 1) throw Error(ErrorKind::kBadArgument, needs_folder(side.option, value, count));
    return value;
}

std::string output_of(const Tool& tool, const FileOptions& files, const std::string& input,
                      std::size_t count) {
    if (files.output.empty()) return "";
    if (tool.fills_output && tool.fills_output()) {
        if (count > 1)
            throw Error(ErrorKind::kBadArgument,
                        cat("-o ", files.output, ": becomes one tile set, of a single input; ", count,
                            " were given"));
        return files.output;
    }
    if (is_folder(files.output))
        return in_folder(files.output, input, files.type.empty() ? tool.type() : files.type);
    if (count > 1) throw Error(ErrorKind::kBadArgument, needs_folder("-o", files.output, count));
    if (!files.type.empty())
        throw Error(ErrorKind::kBadArgument,
                    cat("--format ", files.type, ": ", files.output, " tells the format by its name"));
    return files.output;
}

// All files that a job writes.
std::vector<std::string> outputs_of(const Job& job) {
    std::vector<std::string> outputs;
    if (lower_extension(job.output) == ".gltf")
        outputs = container_files(job.output);
    else if (!job.output.empty())
        outputs = {job.output};
    for (const std::string& side : job.sides)
        if (!side.empty()) outputs.push_back(side);
    return outputs;
}

// Throws where an input is a tile set and the tool takes none.
void check_sets(const Tool& tool, const std::vector<std::string>& inputs) {
    if (tool.instead_of_sets.empty()) return;
    for (const std::string& input : inputs)
        if (is_tile_set(input))
            throw Error(ErrorKind::kUnsupported, cat(input, ": is a tile set, which ", tool.name,
                                                     " does not take; ", tool.instead_of_sets));
}

// Throws where two jobs write the same file.
void check_collisions(const std::vector<Job>& jobs) {
    std::map<std::string, const Job*> job_of;
    for (const Job& job : jobs)
        for (const std::string& output : outputs_of(job)) {
            std::error_code error;  // of paths that cannot be resolved; writing reports the reason
            const fs::path path = fs::weakly_canonical(fs::absolute(output), error);
            const auto [entry, is_new] = job_of.emplace(error ? output : path.string(), &job);
            if (is_new) continue;
            if (entry->second == &job)
                throw Error(ErrorKind::kBadArgument, cat(output, ": is named for two outputs"));
            throw Error(ErrorKind::kBadArgument,
                        cat(entry->second->input, " and ", job.input, " would both become ", output));
        }
}

}  // namespace

bool is_folder(const std::string& path) {
    std::error_code error;
    return path.ends_with('/') || fs::is_directory(path, error);
}

std::string file_type(const std::string& name, const std::string& text) {
    std::string type;
    for (const char c : text.starts_with('.') ? text.substr(1) : text)
        type += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    constexpr std::string_view kUsual = "abcdefghijklmnopqrstuvwxyz0123456789";
    constexpr std::size_t kLongest = 8;
    if (type.empty() || type.size() > kLongest || type.find_first_not_of(kUsual) != std::string::npos)
        throw Error(ErrorKind::kBadArgument, cat(name, " '", text, "': expected an extension, as in png"));
    return type;
}

std::vector<Job> plan_jobs(const Tool& tool, const FileOptions& files) {
    check_sets(tool, files.inputs);
    std::vector<std::string> inputs = files.inputs;
    std::string reference;
    if (tool.compares && inputs.size() > 1) {
        reference = inputs.front();
        inputs.erase(inputs.begin());
    }
    std::vector<Job> jobs;
    for (const std::string& input : inputs) {
        Job job{input, output_of(tool, files, input, inputs.size()), reference, {}};
        for (const SideFile& side : tool.sides)
            job.sides.push_back(side_of(side, files.type, input, inputs.size()));
        jobs.push_back(std::move(job));
    }
    if (tool.check)
        for (const Job& job : jobs) tool.check(job);
    check_collisions(jobs);
    std::vector<std::string> outputs;
    for (const Job& job : jobs)
        for (std::string& output : outputs_of(job)) outputs.push_back(std::move(output));
    check_distinct(files.inputs, outputs);
    return jobs;
}

bool fills_folder(const Tool& tool, const FileOptions& files) {
    if (tool.fills_output && tool.fills_output()) return false;
    return is_folder(files.output) ||
           std::ranges::any_of(tool.sides, [](const SideFile& side) { return is_folder(*side.value); });
}

void make_folders(const Tool& tool, const FileOptions& files) {
    if (files.output.ends_with('/')) make_folder(files.output);
    for (const SideFile& side : tool.sides)
        if (side.value->ends_with('/')) make_folder(*side.value);
}

std::string job_name(const Job& job) {
    return job.reference.empty() ? job.input : cat(job.reference, " against ", job.input);
}

}  // namespace imgmesh
