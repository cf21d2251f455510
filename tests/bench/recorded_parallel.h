// Which work waits for which: parallel loops run on one thread and are written down, so that the time that
// more threads would take follows without having them.
#pragma once

#include <string>
#include <vector>

namespace imgmesh::bench {

/// What a stage of a run has taken, in processor time [s].
struct StageRecord {
    std::string stage;
    double alone = 0;                        ///< outside of parallel loops
    std::vector<std::vector<double>> loops;  ///< of each parallel loop its blocks, in order
};

/// Begins a stage: from now on records count for it. Ends the stage before. Does
/// nothing inside of a parallel loop.
void begin_stage(const std::string& stage);
/// Ends the last stage and returns all of them, in the order in which they began. A stage that was begun
/// again goes on.
std::vector<StageRecord> finish_stages();

/// The time of a stage on so many threads [s]: each thread takes the next block as soon as it has finished
/// one. Memory that is not fast enough for all and the cost of handing over are left out, so this is a lower
/// bound of what a machine takes.
double time_on(const StageRecord& record, int threads);

}  // namespace imgmesh::bench
