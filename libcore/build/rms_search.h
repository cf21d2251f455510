// How far a collapse may go for a wanted error of the reconstruction.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace imgmesh {

/// One run of the collapse: what to do with the mesh at each of some numbers of vertices, which fall. Only
/// meshes that are asked for need be finished, in any order, so the run hands out a function from the index
/// to the error of the finished mesh.
using MeasuredRun = std::function<std::function<double(std::size_t)>(const std::vector<std::int64_t>&)>;

/// Calls `run` twice, first at halvings of `vertices` (>= 4), then at steps of 3 % around the halving after
/// which the error exceeds `rms`, and measures as few meshes as a bisection needs. Errors are taken to rise
/// as vertices fall; where they do not, the mesh found still has an error of at most `rms`.
///
/// keep   called for each measured mesh whose error is at most `rms` and which has fewer vertices than any
///        before it: the last one is the result. Never called where even `vertices` have a larger error.
void search_rms(std::int64_t vertices, double rms, const MeasuredRun& run, const std::function<void()>& keep);

}  // namespace imgmesh
