#include "libcore/coding/grid_schedule.h"

#include <algorithm>
#include <array>

namespace imgmesh {

const GridSchedule& grid_schedule(int effort) {
    static const std::array<GridSchedule, 5> all = {
        GridSchedule{.rounds = 5, .sweeps = 0, .last_rounds = 0},
        GridSchedule{.rounds = 3, .sweeps = 10, .last_rounds = 3},
        GridSchedule{.rounds = 3, .sweeps = 25, .last_rounds = 6},
        GridSchedule{.rounds = 3, .sweeps = 75, .last_rounds = 10},
        GridSchedule{.rounds = 5, .sweeps = 250, .last_rounds = 20},
    };
    return all[static_cast<std::size_t>(std::clamp(effort, 1, 5) - 1)];
}

}  // namespace imgmesh
