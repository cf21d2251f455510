#include "tools/build_jobs.h"

#include <filesystem>
#include <map>

#include "libcore/base/error.h"
#include "tools/common/container_input.h"
#include "tools/common/output.h"

namespace fs = std::filesystem;

namespace imgmesh {

std::vector<Job> plan_jobs(const BuildOptions& o) {
    std::vector<Job> jobs;
    const bool folder = o.output.ends_with('/') || fs::is_directory(o.output);
    if (!folder) {
        if (o.inputs.size() > 1)
            throw Error(ErrorKind::kBadArgument, cat("-o ", o.output, ": ", o.inputs.size(),
                                                     " images need a folder, whose name ends with /"));
        if (!is_container(o.output))
            throw Error(ErrorKind::kBadArgument,
                        cat("-o ", o.output, ": expected a name in .glb or .gltf, or a folder"));
        jobs.push_back({o.inputs.front(), o.output});
    } else {
        std::map<std::string, std::string> input_of;
        for (const std::string& input : o.inputs) {
            const std::string output = fs::path(o.output) / (fs::path(input).stem().string() + ".glb");
            const auto [entry, is_new] = input_of.emplace(output, input);
            if (!is_new)
                throw Error(ErrorKind::kBadArgument,
                            cat(entry->second, " and ", input, " would both become ", output));
            jobs.push_back({input, output});
        }
    }
    std::vector<std::string> outputs;
    for (const Job& job : jobs) {
        for (std::string& file : container_files(job.output)) outputs.push_back(std::move(file));
    }
    check_distinct(o.inputs, outputs);
    if (!o.mask.empty()) check_distinct({o.mask}, outputs);
    return jobs;
}

}  // namespace imgmesh
