// The process that decodes and encodes for this one, with libraries that may crash.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "formats/picture/codecs/codec_server.h"
#include "formats/picture/codecs/shared_memory.h"
#include "formats/picture/codecs/wire.h"
#include "libcore/base/error.h"

namespace imgmesh {

/// How failures of a job are told: "PATH: cannot read the image: its decoder" and then what it did.
struct JobName {
    std::string who;
    ErrorKind kind;  ///< of a crash or a senseless answer
};

/// The error of a job whose answer makes no sense.
Error wrong_answer(const JobName& name);

/// What a job left: its memory, and what it said about it.
struct JobResult {
    SharedMemory memory;  ///< empty if nothing was offered
    ReplyMessage offer;   ///< with sizes that `accept` has permitted
};

/// Starts the program when it is first needed, keeps it for further jobs and starts it again after it has
/// ended, as it does by itself when there was nothing to do for some seconds. Every job runs in a process of
/// its own, which the program forks: jobs of several threads run at the same time, and a crash or damaged
/// memory is over with its job. The program ends with this process, and so do its jobs.
class CodecProcess {
  public:
    /// `find` names the program to start (empty: there is none).
    explicit CodecProcess(std::function<std::string()> find) : find_(std::move(find)) {}

    /// Runs a job and waits for its end. `input` is a header of `header_bytes` and data behind it. `accept`
    /// sees the size of the result before memory is taken, and throws if it is too large. Any thread may call
    /// it. Throws the job's own Error; Error(name.kind) for a job that crashed, took too long or answered
    /// nonsense; Error(kUnsupported) if the program does not start; Error(kIo) if the system has no room for
    /// it.
    JobResult run(const JobName& name, CodecJob job, const SharedMemory& input, std::uint64_t header_bytes,
                  const std::function<void(const ReplyMessage&)>& accept);

  private:
    std::shared_ptr<CodecServer> server();
    void forget(const std::shared_ptr<CodecServer>& server);

    std::function<std::string()> find_;
    std::mutex mutex_;
    std::shared_ptr<CodecServer> server_;
};

/// The process that all of imgmesh shares.
CodecProcess& codec_process();

}  // namespace imgmesh
