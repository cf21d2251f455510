#include "libcore/optimize/grid_schedule.h"

#include <algorithm>
#include <array>

namespace imgmesh {

const GridSchedule& grid_schedule(int effort) {
    static const std::array<GridSchedule, 5> all = {
        GridSchedule{.rounds = 2, .sweeps = 6, .last_rounds = 1},
        GridSchedule{.rounds = 3, .sweeps = 12, .last_rounds = 3},
        GridSchedule{.rounds = 3, .sweeps = 40, .last_rounds = 6},
        GridSchedule{.rounds = 4, .sweeps = 120, .last_rounds = 12},
        GridSchedule{.rounds = 6, .sweeps = 400, .last_rounds = 24},
    };
    return all[static_cast<std::size_t>(std::clamp(effort, 1, 5) - 1)];
}

const GridSchedule& touch_up_schedule() {
    static const GridSchedule schedule{.rounds = 0,
                                       .sweeps = 8,
                                       .temperature = 0.3,
                                       .last_temperature = 0.3,
                                       .last_rounds = 2,
                                       .last_share = 0.3};
    return schedule;
}

}  // namespace imgmesh
