#include "tests/bench/raw_files.h"

#include <array>
#include <cstring>
#include <fstream>
#include <span>
#include <utility>

#include "libcore/base/error.h"

namespace imgmesh::bench {
namespace {

constexpr std::size_t kMagicBytes = 8;
constexpr const char* kFeatureMagic = "IMFEAT1\n";
constexpr const char* kMeshMagic = "IMMESH1\n";

class Writer {
  public:
    Writer(const std::string& path, const char* magic, std::uint32_t a, std::uint32_t b)
        : path_(path), file_(path, std::ios::binary) {
        file_.write(magic, kMagicBytes);
        put(std::span<const std::uint32_t>(&a, 1));
        put(std::span<const std::uint32_t>(&b, 1));
    }
    template <typename T>
    void put(std::span<const T> values) {
        file_.write(reinterpret_cast<const char*>(values.data()),
                    static_cast<std::streamsize>(values.size_bytes()));
    }
    void close() {
        file_.close();
        if (!file_) throw Error(ErrorKind::kIo, cat(path_, ": cannot write"));
    }

  private:
    std::string path_;
    std::ofstream file_;
};

class Reader {
  public:
    Reader(const std::string& path, const char* magic) : path_(path), file_(path, std::ios::binary) {
        if (!file_) throw Error(ErrorKind::kIo, cat(path, ": cannot read"));
        char found[kMagicBytes];
        file_.read(found, kMagicBytes);
        if (!file_ || std::memcmp(found, magic, kMagicBytes) != 0)
            throw Error(ErrorKind::kBadFile, cat(path, ": does not begin with ", std::string(magic, 7)));
    }
    template <typename T>
    void take(std::span<T> values) {
        file_.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(values.size_bytes()));
        if (!file_) throw Error(ErrorKind::kBadFile, cat(path_, ": is too short"));
    }
    std::uint32_t number() {
        std::uint32_t value = 0;
        take(std::span(&value, 1));
        return value;
    }

  private:
    std::string path_;
    std::ifstream file_;
};

}  // namespace

void write_features(const std::string& path, const FeatureImage& feature) {
    Writer file(path, kFeatureMagic, static_cast<std::uint32_t>(feature.width),
                static_cast<std::uint32_t>(feature.height));
    file.put(std::span<const float>(feature.data));
    file.close();
}

FeatureImage read_features(const std::string& path) {
    Reader file(path, kFeatureMagic);
    FeatureImage feature;
    feature.width = static_cast<int>(file.number());
    feature.height = static_cast<int>(file.number());
    feature.channels = 3;
    feature.data.resize(feature.pixel_count() * 3);
    file.take(std::span<float>(feature.data));
    return feature;
}

void write_mesh(const std::string& path, const BaseMesh& mesh) {
    Writer file(path, kMeshMagic, static_cast<std::uint32_t>(mesh.vertex_count()),
                static_cast<std::uint32_t>(mesh.faces.size()));
    for (Id v = 0; v < mesh.vertex_count(); ++v) {
        const float* f = mesh.feature_of(v);
        const std::array<float, 5> values = {mesh.position[v].x(), mesh.position[v].y(), f[0], f[1], f[2]};
        file.put(std::span<const float>(values));
    }
    file.put(std::span<const Face>(mesh.faces));
    file.close();
}

BaseMesh read_mesh(const std::string& path) {
    Reader file(path, kMeshMagic);
    const std::uint32_t vertices = file.number(), faces = file.number();
    BaseMesh mesh;
    mesh.channels = 3;
    for (std::uint32_t v = 0; v < vertices; ++v) {
        std::array<float, 5> values{};
        file.take(std::span<float>(values));
        mesh.position.emplace_back(snapped(values[0]), snapped(values[1]));
        mesh.feature.insert(mesh.feature.end(), values.begin() + 2, values.end());
    }
    for (std::uint32_t f = 0; f < faces; ++f) {
        Face face{};
        file.take(std::span<Id>(face));
        for (const Id v : face)
            if (v >= vertices)
                throw Error(ErrorKind::kBadFile,
                            cat(path, ": face ", f, " has the corner ", v, " of ", vertices, " vertices"));
        const double area2 =
            signed_area2(mesh.position[face[0]], mesh.position[face[1]], mesh.position[face[2]]);
        if (area2 < 0) std::swap(face[1], face[2]);
        if (area2 != 0) mesh.faces.push_back(face);
    }
    return mesh;
}

}  // namespace imgmesh::bench
