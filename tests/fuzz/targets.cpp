#include "tests/fuzz/targets.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "formats/container/container.h"
#include "formats/container/edit_file.h"
#include "formats/container/validate.h"
#include "formats/files/atomic_file.h"
#include "formats/files/byte_reader.h"
#include "formats/picture/decode/picture_decoders.h"
#include "formats/picture/image_io.h"
#include "libcore/base/error.h"
#include "tests/fuzz/small_seeds.h"
#include "tests/support/random_mesh_image.h"
#include "tests/support/small_pictures.h"
#include "tests/support/temporary_folder.h"

namespace imgmesh::fuzz {
namespace {

// Bytes as a file without a disk.
class MemoryFile {
  public:
    explicit MemoryFile(std::span<const std::uint8_t> bytes) : fd_(::memfd_create("fuzz", 0)) {
        if (fd_ < 0) throw std::runtime_error("memfd_create");
        while (!bytes.empty()) {
            const ssize_t n = ::write(fd_, bytes.data(), bytes.size());
            if (n <= 0) throw std::runtime_error("write");
            bytes = bytes.subspan(static_cast<std::size_t>(n));
        }
    }
    ~MemoryFile() { ::close(fd_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    std::string path() const { return cat("/proc/self/fd/", fd_); }

  private:
    int fd_;
};

// What a reader may say; all else is a defect.
template <typename Read>
bool accepts(Read&& read) {
    try {
        read();
        return true;
    } catch (const Error& e) {
        if (e.kind() != ErrorKind::kIo && e.kind() != ErrorKind::kBadFile &&
            e.kind() != ErrorKind::kUnsupported)
            throw;
        if (std::string_view(e.what()).find('\n') != std::string_view::npos)
            throw std::logic_error("a message of more than one line");
        return false;
    }
}

bool feed_container(std::span<const std::uint8_t> bytes) {
    const MemoryFile file(bytes);
    // A file of a few kilobytes could promise 2^28 pixels, each time for a second or two.
    ContainerLimits limits;
    limits.max_pixels = 1 << 22;
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

Bytes noise_picture(const char* extension, int channels) {
    Image image = make_image(13, 9, channels);
    std::mt19937 random(3);
    for (float& sample : image.data) sample = static_cast<float>(random() % 256) / 255;
    if (channels == 2 || channels == 4) image.data.back() = 0.5f;
    const TemporaryFolder folder;
    const std::string path = folder / (std::string("x") + extension);
    write_image(path, image);
    return read_file(path, 1 << 20);
}

}  // namespace

const char* name_of(Target target) {
    switch (target) {
        case Target::kContainer:
            return "container";
        case Target::kPicture:
            return "picture";
        case Target::kSmall:
            return "small";
        case Target::kEdits:
            break;
    }
    return "edits";
}

bool feed(Target target, std::span<const std::uint8_t> bytes) {
    if (target == Target::kContainer) return feed_container(bytes);
    if (target == Target::kEdits)
        return accepts([&] {
            edits_from_json({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "fuzz");
        });
    ImageLimits limits;
    limits.max_pixels = 1 << 22;
    const auto as_data = [](std::span<const std::uint8_t> content) {
        return text_of(content).starts_with("II") || text_of(content).starts_with("MM");
    };
    if (target == Target::kSmall) {
        std::vector<std::uint8_t> copy(bytes.begin(), bytes.end());
        return accepts([&] { decode_picture("fuzz.tga", copy, {.limits = limits}); });
    }
    const MemoryFile file(bytes);
    const bool accepted = accepts([&] { read_image(file.path(), {.limits = limits}); });
    // TIFF has readings of its own for data.
    if (as_data(bytes)) accepts([&] { read_image(file.path(), {.limits = limits, .values = true}); });
    return accepted;
}

std::vector<Bytes> seeds(Target target) {
    std::vector<Bytes> all;
    if (target == Target::kEdits) {
        const std::filesystem::path examples = IMGMESH_SCHEMAS "/examples/valid";
        for (const auto& entry : std::filesystem::directory_iterator(examples))
            if (entry.path().filename().string().starts_with("imgmesh-warp.edits."))
                all.push_back(read_file(entry.path().string(), 1 << 20));
        std::sort(all.begin(), all.end());
    } else if (target == Target::kSmall) {
        all = small_seeds();
    } else if (target == Target::kPicture) {
        for (const char* extension : {".png", ".jpg", ".tif", ".exr", ".webp", ".bmp", ".ppm"})
            all.push_back(noise_picture(extension, 3));
        for (const char* extension : {".png", ".tif", ".exr", ".webp"})
            all.push_back(noise_picture(extension, 4));
        all.push_back(noise_picture(".png", 1));
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(IMGMESH_TEST_DATA "/tiff"))
            names.push_back(entry.path().string());
        std::sort(names.begin(), names.end());
        for (const std::string& name : names) all.push_back(read_file(name, 1 << 20));
    } else {
        const TemporaryFolder folder;
        std::uint32_t seed = 1;
        for (const DracoMode mode : {DracoMode::kEdgebreaker, DracoMode::kSequential, DracoMode::kOff})
            for (const WeightPrecision precision : {WeightPrecision::kHalf, WeightPrecision::kFloat}) {
                const bool mask = ++seed % 2 == 0;
                MeshImage image = random_mesh_image(17, 11, 1 + int(seed % 3), precision, mask, seed);
                if (mask) image.visits.assign(image.levels[0].map.size(), 3);
                ContainerOptions options{mode, true};
                if (!mask) options.texture = {red_png(), texture_coords(image)};
                write_container(folder / "x.glb", image, options);
                all.push_back(read_file(folder / "x.glb", 1 << 24));
            }
    }
    return all;
}

}  // namespace imgmesh::fuzz
