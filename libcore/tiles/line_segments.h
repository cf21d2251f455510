// Which pixels of a line stay vertices: a simplification in one dimension.
#pragma once

#include <span>
#include <vector>

namespace imgmesh {

/// Returns the pixels of a line that remain vertices, ascending; the ends are among them. From all pixels on,
/// the vertex goes whose two segments can best be replaced by one, until each removal would add more than
/// `threshold`. What a removal adds is the increase of the squared error of straight least-squares lines over
/// the pixels, times half the length of the new segment, as in a mesh a vertex of the line stands for a strip
/// that is about as wide as its segments are long, times 32. So the threshold is that of the collapse
/// (SimplifyTarget::max_increment).
///
/// line       pixels, `channels` features each, interleaved
/// threshold  [feature^2 px^2]; >= 0
/// Takes O(n log n) time. The bits are the same on every machine.
std::vector<int> line_vertices(std::span<const float> line, int channels, double threshold);

/// Returns how many vertices line_vertices() leaves at each of the thresholds, in the time of one call.
///
/// thresholds  ascending
std::vector<int> line_vertex_counts(std::span<const float> line, int channels,
                                    std::span<const double> thresholds);

/// Returns which vertices of a polyline remain when half of them go, ascending, as indices; the ends are
/// among them. The one goes whose removal changes the line least, weighted by length as in line_vertices().
///
/// places    of the vertices along the line, ascending [pixels]
/// features  of the vertices, `channels` each, interleaved
std::vector<int> half_of_vertices(std::span<const int> places, std::span<const float> features, int channels);

}  // namespace imgmesh
