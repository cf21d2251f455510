#include "tools/common/file_report.h"

#include <sys/stat.h>

#include <algorithm>

#include "formats/files/sha256.h"
#include "formats/files/stream_file.h"
#include "tools/common/jobs.h"
#include "tools/common/pipes.h"
#include "tools/common/targets.h"

namespace imgmesh {
namespace {

const char* status_name(FileStatus status) {
    switch (status) {
        case FileStatus::kDone:
            return "done";
        case FileStatus::kFailed:
            return "failed";
        case FileStatus::kSkipped:
            return "skipped";
        case FileStatus::kInterrupted:
            break;
    }
    return "interrupted";
}

}  // namespace

FileState::FileState(const std::string& path) {
    struct stat info = {};
    if (::stat(system_path(path).c_str(), &info) != 0) return;
    facts_ = {info.st_dev, info.st_ino, static_cast<std::uint64_t>(info.st_size),
              static_cast<std::uint64_t>(info.st_mtim.tv_sec),
              static_cast<std::uint64_t>(info.st_mtim.tv_nsec)};
}

std::map<std::string, std::string> hash_inputs(const Job& job) {
    std::map<std::string, std::string> hashes;
    for (const std::string& path : {job.reference, job.input})
        if (const std::string hash = file_sha256_hex(path); !hash.empty()) hashes[path] = hash;
    return hashes;
}

Report file_report(const Job& job, const FileResult& file, const Report& parameters) {
    Report report = Report::object();
    if (job.reference.empty())
        report["input"] = job.input;
    else
        report["inputs"] = {{{"input", job.reference}}, {{"input", job.input}}};
    if (!job.output.empty()) report["output"] = shown_name(job.output);
    report["status"] = status_name(file.status);
    if (!file.report.is_null()) report.update(file.report);
    const auto add_hash = [&](Report& input) {
        const auto hash = file.hashes.find(input["input"].get<std::string>());
        if (hash != file.hashes.end()) input["sha256"] = hash->second;
    };
    if (report.contains("inputs")) {
        report.erase("input");
        for (Report& input : report["inputs"]) add_hash(input);
    } else {
        add_hash(report);
    }
    if (report.contains("output")) report["output"] = shown_name(report["output"].get<std::string>());
    Report all = parameters;
    if (report.contains("parameters")) all.update(report["parameters"]);
    report["parameters"] = std::move(all);
    if (!file.warnings.empty()) report["warnings"] = file.warnings;
    if (!file.missed.empty()) report.update(target_report(file.missed));
    if (!file.failures.empty())
        report["failure"] = {{"code", file.failures[0].code}, {"message", file.failures[0].message}};
    return report;
}

std::string file_line(const Tool& tool, const Job& job, const FileResult& file) {
    const std::string names = job.output.empty() ? job_name(job) : cat(job_name(job), " -> ", job.output);
    if (file.status == FileStatus::kSkipped) return cat(names, ": skipped, made before");
    if (file.report.is_null()) return cat(names, ": failed, code ", static_cast<int>(file.failures[0].code));
    return cat(names, ": ", tool.line(file.report));
}

Report summary_report(const std::vector<FileResult>& files, double seconds) {
    const auto count = [&](FileStatus status) {
        return std::ranges::count(files, status, &FileResult::status);
    };
    return {{"files", files.size()},
            {"done", count(FileStatus::kDone)},
            {"skipped", count(FileStatus::kSkipped)},
            {"failed", count(FileStatus::kFailed)},
            {"interrupted", count(FileStatus::kInterrupted)},
            {"seconds", seconds}};
}

Report with_head(const Tool& tool, const std::string& generator, const Report& report) {
    Report whole = {{"$schema", tool.name + ".report.schema.json"}, {"generator", generator}};
    whole.update(report);
    return whole;
}

ExitCode joint_code(const std::vector<Failure>& failures) {
    if (failures.empty()) return ExitCode::kOk;
    for (const Failure& f : failures) {
        if (f.code != failures.front().code) return ExitCode::kBadFile;
    }
    return failures.front().code;
}

}  // namespace imgmesh
