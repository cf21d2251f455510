// One job of the program of codecs, in a process of its own.
#pragma once

#include "formats/picture/codecs/file_descriptor.h"
#include "formats/picture/codecs/wire.h"

namespace imgmesh {

/// Does the job, tells imgmesh on `socket` how it goes, and ends the process.
[[noreturn]] void do_job(const JobMessage& job, FileDescriptor socket, FileDescriptor input);

/// A reply that is an Error.
ReplyMessage error_reply(int kind, const char* text);

}  // namespace imgmesh
