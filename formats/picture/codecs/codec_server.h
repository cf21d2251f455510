// The running program of codecs, as the process that has started it sees it.
#pragma once

#include <sys/types.h>

#include <string>

#include "formats/picture/codecs/file_descriptor.h"

namespace imgmesh {

class CodecServer {
  public:
    /// Starts it: with an environment of its own, in the folder /, without any file of this process but its
    /// socket. Throws Error(kUnsupported) if that fails.
    explicit CodecServer(const std::string& program);
    CodecServer(const CodecServer&) = delete;
    CodecServer& operator=(const CodecServer&) = delete;
    /// Tells it to end, and waits for it.
    ~CodecServer();

    int socket() const { return socket_.get(); }
    /// Whether this process has started it, and is not a copy of the one that has.
    bool is_ours() const;
    /// Why a program has ended.
    struct End {
        std::string reason;      ///< in one line; empty if it ended in good order
        bool by_signal = false;  ///< from outside, or a crash: another start may go better
    };
    /// Waits for the end of a program that has closed its socket.
    End end();

  private:
    int reap();

    FileDescriptor socket_;
    FileDescriptor complaints_;  // what the system writes if the program cannot be loaded
    pid_t process_ = -1;
    pid_t owner_ = -1;
};

}  // namespace imgmesh
