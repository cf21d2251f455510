// What the first pass over a picture leaves in a set's folder.
#pragma once

#include <string>

#include "libcore/tiles/density.h"

namespace imgmesh {

/// Of a row of tiles.
struct RowSample {
    DensitySample counts;
    std::string unread;  ///< why a part of it could not be read, in one line; empty if all could
};

// Each file has the key of the plan that it belongs to. Those of another plan count as absent.

bool has_sample(const std::string& folder, int row, const std::string& key);
void write_sample(const std::string& folder, int row, const std::string& key, const RowSample& sample);
/// Throws Error(kIo) if it is not there, Error(kBadFile) if it is not what write_sample() wrote.
RowSample read_sample(const std::string& folder, int row, const std::string& key);

bool has_threshold(const std::string& folder, const std::string& key);
void write_threshold(const std::string& folder, const std::string& key, double threshold);
/// Throws as read_sample() does.
double read_threshold(const std::string& folder, const std::string& key);

}  // namespace imgmesh
