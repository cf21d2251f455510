#include "tools/common/console.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <iostream>
#include <nlohmann/json.hpp>

#include "libcore/base/error.h"
#include "tools/common/text.h"

namespace imgmesh {
namespace {

// A message quotes names, and those from files may be of any length.
std::string message_line(const std::string& message) {
    constexpr std::size_t kLongest = 1000;
    return shortened(printable_line(message), kLongest);
}

}  // namespace

void write_stream(int fd, const std::string& text) {
    std::size_t done = 0;
    while (done < text.size()) {
        const ssize_t n = ::write(fd, text.data() + done, text.size() - done);
        if (n >= 0) {
            done += static_cast<std::size_t>(n);
        } else if (errno != EINTR) {
            throw Error(ErrorKind::kIo, cat(fd == STDERR_FILENO ? "standard error" : "standard output",
                                            ": cannot write: ", std::strerror(errno)));
        }
    }
}

std::string json_text(const nlohmann::ordered_json& report, bool one_line) {
    // File names may not be UTF-8, which JSON requires.
    using Handler = nlohmann::ordered_json::error_handler_t;
    return printable_json(report.dump(one_line ? -1 : 2, ' ', false, Handler::replace)) + '\n';
}

void print_error(const std::string& tool, const std::string& message) {
    std::cerr << tool << ": error: " << message_line(message) << std::endl;
}

void print_warning(const std::string& tool, const std::string& message) {
    std::cerr << tool << ": warning: " << message_line(message) << std::endl;
}

}  // namespace imgmesh
