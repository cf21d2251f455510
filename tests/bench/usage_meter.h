// What a piece of work costs this process: time on the wall, time of its processors, memory at its peak.
#pragma once

#include <sys/resource.h>

#include <cstdio>
#include <cstring>

#include "libcore/base/stopwatch.h"

namespace imgmesh::bench {

struct Usage {
    double wall_seconds = 0;
    double user_seconds = 0;
    double system_seconds = 0;
    double peak_mib =
        0;  ///< largest resident memory of the process while the work ran, all that was there included
};

/// Measures from its making to stop().
class UsageMeter {
  public:
    UsageMeter() {
        // Linux: forgets the largest resident memory so far. Where that is forbidden, peaks are those since
        // the start.
        if (std::FILE* file = std::fopen("/proc/self/clear_refs", "w")) {
            std::fputs("5", file);
            std::fclose(file);
        }
        getrusage(RUSAGE_SELF, &before_);
        watch_.lap();
    }

    Usage stop() {
        Usage usage;
        usage.wall_seconds = watch_.lap();
        rusage after{};
        getrusage(RUSAGE_SELF, &after);
        usage.user_seconds = seconds(after.ru_utime) - seconds(before_.ru_utime);
        usage.system_seconds = seconds(after.ru_stime) - seconds(before_.ru_stime);
        usage.peak_mib = peak_mib();
        return usage;
    }

  private:
    static double seconds(const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    }
    static double peak_mib() {
        double kib = 0;
        if (std::FILE* file = std::fopen("/proc/self/status", "r")) {
            char line[256];
            while (std::fgets(line, sizeof line, file))
                if (std::strncmp(line, "VmHWM:", 6) == 0) std::sscanf(line + 6, "%lf", &kib);
            std::fclose(file);
        }
        return kib / 1024;
    }

    rusage before_{};
    Stopwatch watch_;
};

}  // namespace imgmesh::bench
