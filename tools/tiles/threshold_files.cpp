#include "tools/tiles/threshold_files.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "formats/files/atomic_file.h"
#include "formats/tileset/tile_files.h"
#include "libcore/base/error.h"
#include "tools/common/output.h"
#include "tools/tiles/tile_jobs.h"

namespace imgmesh {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::uint64_t kMostBytes = 1 << 20;

// Returns what is in a file of that plan; nothing if it is absent, of another plan or broken.
std::optional<Json> read_json(const std::string& path, const std::string& key) {
    if (!std::filesystem::exists(path)) return {};
    const std::vector<std::uint8_t> bytes = read_file(path, kMostBytes);
    Json json = Json::parse(bytes.begin(), bytes.end(), nullptr, false);
    if (json.is_discarded() || !json.is_object() || json.value("plan", Json()) != key) return {};
    return json;
}

Json must_read(const std::string& path, const std::string& key) {
    std::optional<Json> json = read_json(path, key);
    if (!json)
        throw Error(ErrorKind::kIo,
                    cat(path, ": the first pass over the picture has not written it for this plan"));
    return *std::move(json);
}

void write_json(const std::string& path, Json json) {
    make_folder(std::filesystem::path(path).parent_path().string());
    write_text(path, json.dump(1) + "\n", true);
}

std::vector<double> numbers(const std::string& path, const Json& json, const char* name) {
    const Json list = json.value(name, Json());
    const std::size_t count = sample_thresholds().size();
    if (!list.is_array() || list.size() != count ||
        !std::ranges::all_of(list, [](const Json& n) { return n.is_number(); }))
        throw Error(ErrorKind::kBadFile, cat(path, ": ", name, ": expected ", count, " numbers"));
    return list.get<std::vector<double>>();
}

double number(const std::string& path, const Json& json, const char* name) {
    const Json value = json.value(name, Json());
    if (!value.is_number()) throw Error(ErrorKind::kBadFile, cat(path, ": ", name, ": expected a number"));
    return value.get<double>();
}

std::string sample_path(const std::string& folder, int row) {
    return in_set(folder, sample_file(row));
}

}  // namespace

bool has_sample(const std::string& folder, int row, const std::string& key) {
    return read_json(sample_path(folder, row), key).has_value();
}

void write_sample(const std::string& folder, int row, const std::string& key, const RowSample& sample) {
    const DensitySample& counts = sample.counts;
    Json json = {{"plan", key},
                 {"pixels", counts.pixels},
                 {"border", counts.border},
                 {"counted", counts.counted},
                 {"on_sides", counts.on_sides},
                 {"decided", counts.decided}};
    if (!sample.unread.empty()) json["unread"] = sample.unread;
    write_json(sample_path(folder, row), std::move(json));
}

RowSample read_sample(const std::string& folder, int row, const std::string& key) {
    const std::string path = sample_path(folder, row);
    const Json json = must_read(path, key);
    RowSample sample;
    if (const Json unread = json.value("unread", Json()); unread.is_string())
        sample.unread = unread.get<std::string>();
    DensitySample& counts = sample.counts;
    counts.pixels = number(path, json, "pixels");
    counts.border = number(path, json, "border");
    // Where no pixel of the row is inside the mask there are no counts.
    if (counts.pixels == 0) return sample;
    counts.counted = numbers(path, json, "counted");
    counts.on_sides = numbers(path, json, "on_sides");
    counts.decided = numbers(path, json, "decided");
    return sample;
}

bool has_threshold(const std::string& folder, const std::string& key) {
    return read_json(in_set(folder, kThresholdFile), key).has_value();
}

void write_threshold(const std::string& folder, const std::string& key, double threshold) {
    write_json(in_set(folder, kThresholdFile), {{"plan", key}, {"threshold", threshold}});
}

double read_threshold(const std::string& folder, const std::string& key) {
    const std::string path = in_set(folder, kThresholdFile);
    return number(path, must_read(path, key), "threshold");
}

}  // namespace imgmesh
