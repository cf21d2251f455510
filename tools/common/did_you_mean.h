// Proposals for mistyped words.
#pragma once

#include <string>
#include <vector>

namespace imgmesh {

/// Returns the one of `words` that was probably meant by `typed`: the nearest by the number of letters that
/// are wrong, missing, too many or swapped with their neighbour, whatever their case, or else one that begins
/// with it. "" if none is near. Of equally near ones the first counts. Dashes at the beginning are left out.
std::string nearest_word(const std::string& typed, const std::vector<std::string>& words);

/// Returns "; did you mean WORD?" for that word, or "".
std::string did_you_mean(const std::string& typed, const std::vector<std::string>& words);

}  // namespace imgmesh
