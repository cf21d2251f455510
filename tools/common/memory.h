// How much memory a tool may take. It is estimated before the work: what is too large gets one line, not the
// end of the process by the system.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

/// Three quarters of the memory of the machine, or of the control group of this process if that is less
/// [bytes]. Where neither can be read, there is no limit.
std::uint64_t usual_max_memory();

/// Reads a size in bytes: a number, perhaps with k, M, G or T for powers of 1000, as in "2G". Throws
/// Error(kBadArgument) for other text and for sizes below 1 MB; `name` is the option.
std::uint64_t parse_memory(const std::string& name, const std::string& text);

/// What a program and its libraries take, whatever they work on [bytes].
inline constexpr double kProgramMemory = 16e6;

/// What a program takes in all that reads a container and then takes `work` bytes beside the maps and meshes
/// of its levels [bytes].
double container_memory(const MeshImage& mesh_image, double work);

/// Throws Error(kBadFile) if `bytes`, an estimate, are more than `most`; `what` needs them, as in
/// "a.glb: a drawing of 40 x 30 pixels".
void check_memory(const std::string& what, double bytes, std::uint64_t most);

/// Lets jobs run at the same time as long as all of them together take no more than a limit.
class MemoryGate {
  public:
    explicit MemoryGate(std::uint64_t most) : most_(static_cast<double>(most)) {}

    /// What a job takes, until its end.
    class Share {
      public:
        Share(MemoryGate& gate, double bytes) : gate_(gate), bytes_(bytes) { gate_.enter(bytes_); }
        ~Share() { gate_.leave(bytes_); }
        Share(const Share&) = delete;
        Share& operator=(const Share&) = delete;

      private:
        MemoryGate& gate_;
        double bytes_;
    };

  private:
    void enter(double bytes);  // waits; a job that is alone enters whatever it takes
    void leave(double bytes);

    std::mutex mutex_;
    std::condition_variable left_;
    double most_;
    double taken_ = 0;
    int jobs_ = 0;
};

/// What the work on one file takes, while other files are worked on.
class JobMemory {
  public:
    /// most: the limit of all jobs of `gate` together, and of each [bytes].
    JobMemory(MemoryGate& gate, std::uint64_t most) : gate_(&gate), most_(most) {}

    /// Throws as check_memory() does, else waits until the other jobs leave that much, and what was taken
    /// before. It is theirs again when this object ends.
    void take(const std::string& what, double bytes);
    /// The same for work on a container that takes `bytes_a_pixel` for each of its pixels, beside the maps
    /// and meshes of its levels.
    void take_for(const std::string& path, const MeshImage& mesh_image, double bytes_a_pixel);

  private:
    MemoryGate* gate_;
    std::uint64_t most_;
    double bytes_ = 0;
    std::optional<MemoryGate::Share> share_;
};

}  // namespace imgmesh
