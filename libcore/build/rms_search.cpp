#include "libcore/build/rms_search.h"

#include <algorithm>
#include <limits>

namespace imgmesh {

void search_rms(std::int64_t vertices, double rms, const MeasuredRun& run,
                const std::function<void()>& keep) {
    std::int64_t fewest = std::numeric_limits<std::int64_t>::max();
    // The last index of a run whose error is low enough, by bisection between indices known to be so (or -1)
    // and not (or the size); from what is not at most `back` steps at once.
    const auto search = [&](const std::vector<std::int64_t>& counts, std::size_t first, std::ptrdiff_t back) {
        const auto error_at = run(counts);
        std::ptrdiff_t good = -1, bad = static_cast<std::ptrdiff_t>(counts.size());
        auto k = static_cast<std::ptrdiff_t>(first);
        while (bad - good > 1) {
            const auto index = static_cast<std::size_t>(k);
            if (error_at(index) <= rms) {
                good = k;
                if (counts[index] < fewest) {
                    fewest = counts[index];
                    keep();
                }
            } else {
                bad = k;
            }
            k = good < 0 ? std::max((good + bad) / 2, bad - back) : (good + bad) / 2;
        }
        return good;
    };
    constexpr std::int64_t kLeast = 4;
    std::vector<std::int64_t> halvings;
    for (std::int64_t n = vertices; n >= kLeast; n /= 2) halvings.push_back(n);
    // Fine meshes take long to finish: towards them one halving at a time, from 1/128 on.
    const std::ptrdiff_t good = search(halvings, std::min<std::size_t>(7, halvings.size() - 1), 1);
    if (good < 0) return;
    // Neighbouring steps differ by 3 %, in error by about half of that.
    const std::int64_t most = halvings[static_cast<std::size_t>(good)], least = std::max(kLeast, most / 2);
    std::vector<std::int64_t> steps;
    for (double n = static_cast<double>(most); n > static_cast<double>(least); n *= 0.97)
        if (steps.empty() || static_cast<std::int64_t>(n) < steps.back())
            steps.push_back(static_cast<std::int64_t>(n));
    if (steps.empty() || steps.back() > least) steps.push_back(least);
    search(steps, steps.size() / 2, most);
}

}  // namespace imgmesh
