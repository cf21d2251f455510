// The exit codes of the tools, for scripts.
#pragma once

#include "libcore/base/error.h"

namespace imgmesh {

/// Exit codes of every tool; `--help` prints them with their meanings.
enum class ExitCode : int {
    kOk = 0,
    kInternal = 1,
    kUsage = 2,
    kIo = 3,
    kBadFile = 4,
    kUnsupported = 5,
    kDifferent = 7,
};

constexpr ExitCode exit_code(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::kBadArgument:
            return ExitCode::kUsage;
        case ErrorKind::kIo:
            return ExitCode::kIo;
        case ErrorKind::kBadFile:
            return ExitCode::kBadFile;
        case ErrorKind::kUnsupported:
            return ExitCode::kUnsupported;
        case ErrorKind::kInternal:
            break;
    }
    return ExitCode::kInternal;
}

}  // namespace imgmesh
