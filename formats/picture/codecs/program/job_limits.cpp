#include "formats/picture/codecs/program/job_limits.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <ctime>

namespace imgmesh {
namespace {

// A limit of this process, never above what it was allowed at first.
class Limit {
  public:
    explicit Limit(__rlimit_resource resource) : resource_(resource) {
        known_ = ::getrlimit(resource, &first_) == 0;
    }
    void set(rlim_t value) const {
        struct rlimit limit = first_;
        limit.rlim_cur = std::min(value, first_.rlim_cur);
        if (known_) ::setrlimit(resource_, &limit);
    }

  private:
    __rlimit_resource resource_;
    struct rlimit first_ = {};
    bool known_;
};

}  // namespace

void limit_job(std::uint64_t samples, [[maybe_unused]] std::uint64_t input_bytes) {
    static const Limit memory(RLIMIT_AS), time(RLIMIT_CPU);
    samples = std::min(samples, std::uint64_t{1} << 44);  // no sum below overflows
// Not with sanitizers, whose shadow memory takes terabytes of addresses.
#ifndef IMGMESH_SANITIZED
    constexpr std::uint64_t kRest = std::uint64_t{512} << 20;
    // JPEG 2000's wavelets take 4 bytes a sample three times over; HEIF's decoder keeps some images.
    constexpr std::uint64_t kBytesOfSample = 32;
    unsigned long pages = 0;
    if (std::FILE* file = std::fopen("/proc/self/statm", "re")) {
        if (std::fscanf(file, "%lu", &pages) == 1)
            memory.set(pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)) + kRest +
                       samples * kBytesOfSample + 4 * input_bytes);
        std::fclose(file);
    }
#endif
    // The slowest, JPEG 2000, decodes some millions of samples a second.
    constexpr std::uint64_t kSeconds = 60, kSamplesOfSecond = 200000;
    const auto used = static_cast<std::uint64_t>(std::clock() / CLOCKS_PER_SEC);
    time.set(used + kSeconds + samples / kSamplesOfSecond);
}

}  // namespace imgmesh
