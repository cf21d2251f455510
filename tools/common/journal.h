// What earlier runs have made in a folder, so that a batch can go on where it was ended.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "tools/common/tool_main.h"

namespace imgmesh {

/// The hidden file of a folder with a line of JSON for each output that was made there. Any process may add
/// lines at any time; the last one of an output counts. What it says is believed only of files whose content
/// it knows, and it may be removed.
class Journal {
  public:
    /// Its name in the folder.
    static constexpr const char* kName = ".imgmesh-done.jsonl";

    /// A journal of `folder` ("" for the working one). It has no entries until read().
    explicit Journal(const std::string& folder);

    /// Reads the entries of these outputs, names without a folder. Lines that are torn, too long or no
    /// entries are left out; a journal that is no regular file, or of 1 GiB or more, has none.
    void read(const std::set<std::string>& outputs);

    /// Returns why read() did not use the journal, in a line for its user; "" if it did or there is none.
    const std::string& trouble() const { return trouble_; }

    /// Returns the report of `output` if it was made by `key` and the files, its own first, are still what
    /// they were; null if not. Reads the files. Any thread may call it.
    Report find(const std::string& output, const std::string& key,
                const std::vector<std::string>& files) const;

    /// Adds an entry, and flushes it to disk. Throws Error(kIo). Any thread may call it.
    void add(const std::string& output, const std::string& key, const std::vector<std::string>& files,
             const Report& report);

  private:
    std::string path_, trouble_;
    std::map<std::string, std::string> line_of_;
    std::mutex mutex_;
};

/// Returns what an output depends on, as a hash; "" if that cannot be told because a file can be read only
/// once. generator: "imgmesh-build 0.1.0"; hashes: hash_inputs(job).
std::string journal_key(const Tool& tool, const std::string& generator, const Job& job,
                        const Report& parameters, const std::map<std::string, std::string>& hashes);

/// Returns the name of a job's entry, and the folder whose journal has it.
std::string journal_name(const Job& job);
std::string journal_folder(const Job& job);

/// Returns the files that a finished job has written, a .gltf's own ones too.
std::vector<std::string> written_files(const Job& job);

}  // namespace imgmesh
