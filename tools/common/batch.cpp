#include "tools/common/batch.h"

#include <unistd.h>

#include <atomic>
#include <condition_variable>
#include <filesystem>
#include <iomanip>
#include <mutex>
#include <optional>
#include <sstream>

#include "libcore/base/parallel.h"
#include "libcore/base/stopwatch.h"
#include "tools/common/console.h"
#include "tools/common/file_report.h"
#include "tools/common/interruption.h"
#include "tools/common/jobs.h"
#include "tools/common/joint_progress.h"
#include "tools/common/progress_bar.h"
#include "tools/common/targets.h"
#include "tools/common/text.h"

namespace imgmesh {
namespace {

// After a signal, files that are worked on may finish in this time.
constexpr std::chrono::seconds kGrace{1};
// More names of files that were not done would hide the rest of the report, which --json has in full.
constexpr std::size_t kMostNames = 20;

class Batch {
  public:
    Batch(const Tool& tool, const std::vector<Job>& jobs, const BatchOptions& options)
        : tool_(tool),
          jobs_(jobs),
          options_(options),
          many_(jobs.size() > 1),
          files_(jobs.size()),
          gate_(options.max_memory),
          bar_(!options.quiet && ::isatty(STDERR_FILENO)),
          show_([this](double fraction, std::string_view stage) { bar_.show(fraction, stage); }),
          progress_(jobs.size(), show_) {}

    ExitCode run();

  private:
    void work(std::size_t index);
    FileResult made_before(const Job& job);
    void do_work(std::size_t index, FileResult& file);
    Progress progress_of(std::size_t index);
    void announce(const FileResult& file);
    void write(const std::string& text);
    void end_by_signal();
    void end_folder_by_signal();
    void conclude();
    std::string report_text() const;
    std::string summary_line() const;

    const Tool& tool_;
    const std::vector<Job>& jobs_;
    const BatchOptions& options_;
    const bool many_;
    std::mutex mutex_;  // of what follows
    std::condition_variable finished_;
    std::vector<FileResult> files_;
    int running_ = 0;
    bool concluded_ = false;
    std::optional<Error> lost_output_;
    Stopwatch time_;
    double seconds_ = 0;

    std::atomic<std::size_t> next_ = 0, done_ = 0;
    std::atomic<bool> stopped_ = false, lost_journal_ = false;
    MemoryGate gate_;
    ProgressBar bar_;
    const Progress show_;
    JointProgress progress_;
};

Progress Batch::progress_of(std::size_t index) {
    if (!many_) return show_;
    const std::string name = std::filesystem::path(jobs_[index].input).filename().string();
    return [this, index, name = printable_line(name)](double fraction, std::string_view stage) {
        progress_.show(index, fraction, cat(done_ + 1, '/', jobs_.size(), ' ', name, ' ', stage));
    };
}

// Returns the result of an earlier run, or one that is not done yet, with the hashes of what is read.
FileResult Batch::made_before(const Job& job) {
    FileResult file;
    if (options_.json || options_.json_lines || options_.journal) {
        file.input = FileState(job.input);
        file.hashes = hash_inputs(job);
    }
    if (!options_.journal) return file;
    file.key = journal_key(tool_, options_.generator, job, options_.journal_parameters, file.hashes);
    if (!options_.skip_existing || file.key.empty()) return file;
    file.report = options_.journal->find(journal_name(job), file.key, written_files(job));
    if (file.report.is_null()) return file;
    // What missed its numbers fails now, in its own words.
    if (options_.strict && file.report.value("target_reached", Report()) == false) {
        file.report = nullptr;
        return file;
    }
    file.status = FileStatus::kSkipped;
    const std::string earlier = file.report["input"].get<std::string>() + ": ";
    for (std::string warning : file.report.value("warnings", std::vector<std::string>())) {
        // The same content may have had another name.
        if (warning.starts_with(earlier)) warning = cat(job.input, ": ", warning.substr(earlier.size()));
        file.warnings.push_back(std::move(warning));
    }
    for (const char* member : {"input", "output", "status"}) file.report.erase(member);
    return file;
}

void Batch::do_work(std::size_t index, FileResult& file) {
    const Job& job = jobs_[index];
    Context context{options_.generator, options_.overwrite, options_.max_memory,
                    JobMemory(gate_, options_.max_memory), progress_of(index)};
    try {
        file.report = tool_.run(job, context);
    } catch (const MissedTargets& error) {
        context.failures.push_back(current_failure());
        file.missed = error.missed();
    } catch (...) {
        // A bad file does not stop the others.
        context.failures.push_back(current_failure());
        if (context.failures.back().code == ExitCode::kInternal)
            context.failures.back().message = cat(job_name(job), ": ", context.failures.back().message);
    }
    file.status = context.failures.empty() ? FileStatus::kDone : FileStatus::kFailed;
    file.warnings = std::move(context.warnings);
    file.failures = std::move(context.failures);
    // Of an input that was changed meanwhile nobody knows what was read.
    if (file.status != FileStatus::kDone || file.key.empty() || FileState(job.input) != file.input) return;
    try {
        options_.journal->add(journal_name(job), file.key, written_files(job),
                              file_report(job, file, options_.parameters));
    } catch (const Error& error) {
        if (!lost_journal_.exchange(true))
            file.warnings.push_back(cat(error.what(), "; --skip-existing will not know what was made"));
    }
}

void Batch::work(std::size_t index) {
    const Job& job = jobs_[index];
    {
        const std::lock_guard lock(mutex_);
        if (stopped_) return;
        ++running_;
    }
    FileResult file = made_before(job);
    if (file.status != FileStatus::kSkipped) do_work(index, file);
    if (index == 0 && options_.journal && !options_.journal->trouble().empty())
        file.warnings.push_back(options_.journal->trouble());
    {
        const std::lock_guard lock(mutex_);
        if (concluded_) return;  // and the process is about to end
        files_[index] = std::move(file);
        --running_;
        ++done_;
        announce(files_[index]);
        if (many_) progress_.show(index, 1, cat(done_.load(), '/', jobs_.size(), " done"));
    }
    finished_.notify_all();
}

// Prints what is told of a file as it finishes.
void Batch::announce(const FileResult& file) {
    const Job& job = jobs_[static_cast<std::size_t>(&file - files_.data())];
    bar_.above([&] {
        // JSON on standard error has them already, and has no other lines among its own.
        if (options_.stream != STDERR_FILENO || !(options_.json || options_.json_lines)) {
            for (const std::string& warning : file.warnings) print_warning(tool_.name, warning);
            for (const Failure& failure : file.failures) print_error(tool_.name, failure.message);
        }
        if (options_.json_lines)
            write(json_text(with_head(tool_, options_.generator, file_report(job, file, options_.parameters)),
                            true));
        else if (many_ && !options_.json && !options_.quiet)
            write(printable_line(file_line(tool_, job, file)) + '\n');
    });
}

// Standard output may go away while a batch works. What it makes is worth more than what it prints, unless it
// prints alone.
void Batch::write(const std::string& text) {
    if (lost_output_) return;
    try {
        write_stream(options_.stream, text);
    } catch (const Error& error) {
        lost_output_ = error;
        if (tool_.output_help.empty()) stopped_ = true;
    }
}

std::string Batch::summary_line() const {
    const Report summary = summary_report(files_, seconds_);
    std::string line = cat(files_.size(), " files: ", summary["done"], " done");
    for (const auto& [key, text] : {std::pair("skipped", "skipped"), std::pair("failed", "failed"),
                                    std::pair("interrupted", "not done")})
        if (summary[key] != 0) line += cat(", ", summary[key], ' ', text);
    return cat(line, "; ", format_number(seconds_), " s\n");
}

// What is printed at the end.
std::string Batch::report_text() const {
    if (options_.json_lines)
        return json_text(
            with_head(tool_, options_.generator, {{"summary", summary_report(files_, seconds_)}}), true);
    if (options_.json) {
        if (!many_ && !tool_.always_list)
            return json_text(
                with_head(tool_, options_.generator, file_report(jobs_[0], files_[0], options_.parameters)),
                false);
        Report list = Report::array();
        std::vector<std::string> warnings;
        for (std::size_t i = 0; i < files_.size(); ++i) {
            list.push_back(file_report(jobs_[i], files_[i], options_.parameters));
            warnings.insert(warnings.end(), files_[i].warnings.begin(), files_[i].warnings.end());
        }
        Report report = {{tool_.list, list}, {"summary", summary_report(files_, seconds_)}};
        if (!warnings.empty()) report["warnings"] = warnings;
        return json_text(with_head(tool_, options_.generator, report), false);
    }
    if (options_.quiet) return "";
    if (many_) return summary_line();
    if (files_[0].status == FileStatus::kSkipped)
        return printable_line(file_line(tool_, jobs_[0], files_[0])) + '\n';
    if (files_[0].report.is_null()) return "";
    std::ostringstream lines;
    tool_.print(file_report(jobs_[0], files_[0], options_.parameters), lines);
    return printable_text(lines.str());
}

void Batch::conclude() {
    concluded_ = true;
    seconds_ = time_.lap();
    bar_.above([&] { write(report_text()); });
}

void Batch::end_by_signal() {
    stopped_ = true;
    std::unique_lock lock(mutex_);
    finished_.wait_for(lock, kGrace, [&] { return running_ == 0; });
    std::vector<std::string> left;
    for (std::size_t i = 0; i < files_.size(); ++i)
        if (files_[i].status == FileStatus::kInterrupted) left.push_back(jobs_[i].input);
    bar_.above([&] {
        print_error(tool_.name, cat("interrupted: ", files_.size() - left.size(), " of ", files_.size(),
                                    " files are done"));
        if (options_.json || options_.json_lines || options_.quiet) {
            if (!options_.json_lines) return;
            for (std::size_t i = 0; i < files_.size(); ++i)
                if (files_[i].status == FileStatus::kInterrupted)
                    write(json_text(with_head(tool_, options_.generator,
                                              file_report(jobs_[i], files_[i], options_.parameters)),
                                    true));
            return;
        }
        std::string text;
        for (std::size_t i = 0; i < std::min(left.size(), kMostNames); ++i)
            text += printable_line(left[i]) + ": not done\n";
        if (left.size() > kMostNames) text += cat("and ", left.size() - kMostNames, " more: not done\n");
        write(text);
    });
    conclude();
}

void Batch::end_folder_by_signal() {
    bar_.above([&] {
        print_error(tool_.name,
                    cat("interrupted: ", jobs_[0].output, " is not complete; the same command goes on"));
    });
}

ExitCode Batch::run() {
    {
        std::optional<Interruption> interruption;
        if (many_)
            interruption.emplace([this](int) { end_by_signal(); });
        else if (tool_.fills_output && tool_.fills_output())
            interruption.emplace([this](int) { end_folder_by_signal(); });
        // Blocks begin in any order, files in that of the command line.
        parallel_blocks(0, static_cast<int>(jobs_.size()), 1, [&](int, int) { work(next_++); });
    }
    const std::lock_guard lock(mutex_);
    conclude();
    if (lost_output_) throw *lost_output_;
    std::vector<Failure> failures;
    for (const FileResult& file : files_)
        failures.insert(failures.end(), file.failures.begin(), file.failures.end());
    return joint_code(failures);
}

}  // namespace

ExitCode run_batch(const Tool& tool, const std::vector<Job>& jobs, const BatchOptions& options) {
    return Batch(tool, jobs, options).run();
}

}  // namespace imgmesh
