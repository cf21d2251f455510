// This file takes the place of libcore/base/parallel.cpp in the program that it is linked into. Loops inside
// a block of another loop count as part of that block.
#include "tests/bench/recorded_parallel.h"

#include <time.h>

#include <algorithm>
#include <utility>

#include "libcore/base/parallel.h"

namespace imgmesh {
namespace {

double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Recorder {
    std::vector<bench::StageRecord> stages;
    std::size_t current = 0;
    double last = 0;  // end of what has been written down
    bool inside = false;

    // The time since `last`.
    double lap() {
        const double now = processor_seconds();
        return now - std::exchange(last, now);
    }
};
Recorder recorder;

}  // namespace

struct ThreadLimit::Control {};
ThreadLimit::ThreadLimit(int /*threads*/) {}
ThreadLimit::~ThreadLimit() = default;

int hardware_threads() {
    return 1;
}

void parallel_blocks(int begin, int end, int grain, const std::function<void(int, int)>& body) {
    const bool outermost = !recorder.inside && !recorder.stages.empty();
    std::vector<double> blocks;
    if (outermost) {
        recorder.inside = true;
        recorder.stages[recorder.current].alone += recorder.lap();
    }
    for (int first = begin; first < end; first += std::min(grain, end - first)) {
        body(first, first + std::min(grain, end - first));
        if (outermost) blocks.push_back(recorder.lap());
    }
    if (!outermost) return;
    recorder.inside = false;
    recorder.stages[recorder.current].loops.push_back(std::move(blocks));
}

namespace bench {

void begin_stage(const std::string& stage) {
    if (recorder.inside) return;  // a block says how far it is
    if (recorder.stages.empty())
        recorder.lap();
    else
        recorder.stages[recorder.current].alone += recorder.lap();
    const auto at = std::ranges::find(recorder.stages, stage, &StageRecord::stage);
    recorder.current = static_cast<std::size_t>(at - recorder.stages.begin());
    if (at == recorder.stages.end()) recorder.stages.push_back({stage, 0, {}});
}

std::vector<StageRecord> finish_stages() {
    if (!recorder.stages.empty()) recorder.stages[recorder.current].alone += recorder.lap();
    return std::exchange(recorder.stages, {});
}

double time_on(const StageRecord& record, int threads) {
    double sum = record.alone;
    for (const std::vector<double>& blocks : record.loops) {
        std::vector<double> busy_until(static_cast<std::size_t>(threads), 0.0);
        for (const double block : blocks) *std::ranges::min_element(busy_until) += block;
        sum += *std::ranges::max_element(busy_until);
    }
    return sum;
}

}  // namespace bench
}  // namespace imgmesh
