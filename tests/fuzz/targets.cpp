#include "tests/fuzz/targets.h"

#include <algorithm>
#include <iterator>

#include "formats/container/container.h"
#include "formats/container/edit_file.h"
#include "formats/container/validate.h"
#include "tests/fuzz/feeds.h"

namespace imgmesh::fuzz {
namespace {

constexpr const char* kNames[] = {"container", "png",     "jpeg",  "tiff",   "exr",     "webp",
                                  "bmp",       "tga",     "pnm",   "gif",    "hdr",     "jp2",
                                  "heif",      "profile", "edits", "config", "compact", "coded"};
static_assert(std::size(kNames) == static_cast<std::size_t>(kLastTarget) + 1);

bool feed_container(std::span<const std::uint8_t> bytes) {
    const MemoryFile file(bytes);
    // A file of a few kilobytes could promise 2^28 pixels, each time for a second or two.
    ContainerLimits limits;
    limits.max_pixels = 1 << 18;
    std::string message;
    const bool accepted = accepts([&] {
        try {
            read_container(file.path(), limits);
        } catch (const Error& e) {
            message = e.what();
            throw;
        }
    });
    std::vector<Issue> issues;
    const bool validated = accepts([&] { issues = validate_container(file.path(), limits); });
    if (!validated) {
        if (accepted) throw std::logic_error("the validator cannot read what the reader reads");
        return false;  // a file beside, which is not there
    }
    const auto error = std::find_if(issues.begin(), issues.end(), [](const Issue& issue) {
        return issue.finding->severity == Severity::kError;
    });
    if (accepted != (error == issues.end())) throw std::logic_error("reader and validator disagree");
    if (!accepted && message.find(cat("[", error->finding->code, "]")) == std::string::npos)
        throw std::logic_error("reader and validator disagree about the first error");
    return accepted;
}

}  // namespace

const char* name_of(Target target) {
    return kNames[static_cast<std::size_t>(target)];
}

std::optional<Target> target_of(std::string_view name) {
    const auto at = std::find(std::begin(kNames), std::end(kNames), name);
    if (at == std::end(kNames)) return std::nullopt;
    return static_cast<Target>(at - std::begin(kNames));
}

bool feed(Target target, std::span<const std::uint8_t> bytes) {
    switch (target) {
        case Target::kContainer:
            return feed_container(bytes);
        case Target::kEdits:
            return accepts([&] {
                edits_from_json({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "fuzz");
            });
        case Target::kProfile:
            return feed_profile(bytes);
        case Target::kConfig:
            return feed_config(bytes);
        case Target::kCompact:
            return feed_compact(bytes);
        case Target::kCoded:
            return feed_coded(bytes);
        default:
            return feed_image(target, bytes);
    }
}

Bytes mutated(Target target, const Bytes& bytes, Mutator& mutator) {
    switch (target) {
        case Target::kContainer:
            return mutator.glb(bytes);
        case Target::kPng:
            return mutator.png(bytes);
        case Target::kEdits: {
            const std::string text = mutator.json_text({bytes.begin(), bytes.end()});
            return {text.begin(), text.end()};
        }
        default:
            return mutator.any(bytes);
    }
}

}  // namespace imgmesh::fuzz
