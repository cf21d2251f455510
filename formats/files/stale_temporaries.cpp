#include "formats/files/stale_temporaries.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>
#include <mutex>
#include <set>
#include <string_view>

namespace imgmesh {
namespace {

// For file systems whose locks do not reach other machines.
constexpr std::time_t kUntouchedSeconds = 3600;

// ".imgmesh-123-4.png"
bool is_temporary(std::string_view name) {
    const std::string_view prefix = kTemporaryPrefix;
    if (!name.starts_with(prefix)) return false;
    name.remove_prefix(prefix.size());
    const auto digits = [&] {
        const std::size_t end = std::min(name.find_first_not_of("0123456789"), name.size());
        name.remove_prefix(end);
        return end > 0;
    };
    if (!digits() || !name.starts_with('-')) return false;
    name.remove_prefix(1);
    return digits() && (name.empty() || name.front() == '.');
}

bool same_file(const struct stat& a, const struct stat& b) {
    return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

void remove_if_stale(int folder, const char* name, std::time_t untouched) {
    struct stat named = {};
    if (::fstatat(folder, name, &named, AT_SYMLINK_NOFOLLOW) != 0) return;
    if (!S_ISREG(named.st_mode) || named.st_uid != ::geteuid() ||
        std::time(nullptr) - named.st_mtime < untouched)
        return;
    // For writing: a network file system locks nothing else.
    const int fd = ::openat(folder, name, O_WRONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0) return;
    struct stat opened = {};
    // Under the lock, so that a run that has just made the file notices when it claims it.
    if (::flock(fd, LOCK_EX | LOCK_NB) == 0 && ::fstat(fd, &opened) == 0 &&
        ::fstatat(folder, name, &named, AT_SYMLINK_NOFOLLOW) == 0 && same_file(opened, named))
        ::unlinkat(folder, name, 0);
    ::close(fd);
}

// Returns whether this is the process's first time in the folder.
bool is_new(const struct stat& folder) {
    static std::mutex mutex;
    static std::set<std::pair<dev_t, ino_t>> seen;
    const std::lock_guard lock(mutex);
    return seen.emplace(folder.st_dev, folder.st_ino).second;
}

// Closes the descriptor.
void remove_all_stale(int folder, std::time_t untouched) {
    DIR* const entries = ::fdopendir(folder);
    if (!entries) {
        ::close(folder);
        return;
    }
    while (const dirent* entry = ::readdir(entries))
        if (is_temporary(entry->d_name)) remove_if_stale(folder, entry->d_name, untouched);
    ::closedir(entries);
}

int open_folder(const std::string& folder) {
    return ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
}

}  // namespace

bool claim_temporary(int fd, const std::string& path) {
    while (::flock(fd, LOCK_EX) != 0)
        if (errno != EINTR) return true;  // there are no locks here, so nobody else gets one either
    return is_named(fd, path);
}

bool is_named(int fd, const std::string& path) {
    struct stat opened = {}, named = {};
    return ::fstat(fd, &opened) == 0 && ::lstat(path.c_str(), &named) == 0 && same_file(opened, named);
}

void remove_stale_temporaries(const std::string& folder) {
    const int fd = open_folder(folder);
    if (fd < 0) return;
    struct stat info = {};
    if (::fstat(fd, &info) == 0 && is_new(info))
        remove_all_stale(fd, kUntouchedSeconds);
    else
        ::close(fd);
}

void remove_unclaimed_temporaries(const std::string& folder) {
    const int fd = open_folder(folder);
    if (fd >= 0) remove_all_stale(fd, 0);
}

}  // namespace imgmesh
