// An open file that is closed with its owner.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <utility>

namespace imgmesh {

class FileDescriptor {
  public:
    FileDescriptor() = default;
    explicit FileDescriptor(int number) : number_(number) {}
    FileDescriptor(FileDescriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    FileDescriptor& operator=(FileDescriptor&& other) noexcept {
        if (this != &other) {
            close();
            number_ = std::exchange(other.number_, -1);
        }
        return *this;
    }
    ~FileDescriptor() { close(); }

    int get() const { return number_; }
    explicit operator bool() const { return number_ >= 0; }
    void close() {
        if (number_ >= 0) ::close(number_);
        number_ = -1;
    }

  private:
    int number_ = -1;
};

/// The same file under a number above 3: a process that has closed its standard streams would write into a
/// file of their numbers, and the program of codecs gets its socket as 3. Empty if there is no number left.
inline FileDescriptor above_standard(FileDescriptor file) {
    constexpr int kFirst = 4;
    if (!file || file.get() >= kFirst) return file;
    return FileDescriptor(::fcntl(file.get(), F_DUPFD_CLOEXEC, kFirst));
}

}  // namespace imgmesh
