#include "formats/gltf/stored_mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <compare>
#include <numeric>
#include <span>

#include "formats/files/sha256.h"
#include "formats/findings/findings.h"
#include "libcore/base/error.h"
#include "libcore/image/color.h"

namespace imgmesh {
namespace {

static_assert(std::endian::native == std::endian::little,
              "arrays are hashed and stored as they lie in memory");

bool on_grid(float coordinate) {
    const float steps = coordinate / kPositionStep;  // exact: a power of two
    return std::abs(coordinate) < float{kMaxCoordinate} && steps == std::floor(steps);
}

std::array<Vec2f, 3> corners(const BaseMesh& mesh, const Face& face) {
    return {mesh.position[face[0]], mesh.position[face[1]], mesh.position[face[2]]};
}

// As <=> of arrays, which not every library has.
template <typename T, std::size_t N>
std::partial_ordering order_of(const std::array<T, N>& a, const std::array<T, N>& b) {
    for (std::size_t i = 0; i < N; ++i)
        if (const std::partial_ordering order = a[i] <=> b[i]; order != 0) return order;
    return std::partial_ordering::equivalent;
}

struct Corner {
    std::array<float, 3> position;
    std::array<std::uint16_t, 4> color;
    const StoredMesh* mesh;
    Id vertex;

    std::partial_ordering operator<=>(const Corner& other) const {
        if (const auto order = order_of(position, other.position); order != 0) return order;
        if (const auto order = order_of(color, other.color); order != 0) return order;
        if (!mesh->hdr.empty())
            if (const auto order = order_of(mesh->hdr[vertex], other.mesh->hdr[other.vertex]); order != 0)
                return order;
        for (std::size_t c = 0; c < mesh->channels.size(); ++c)
            if (const auto order = mesh->channels[c][vertex] <=> other.mesh->channels[c][other.vertex];
                order != 0)
                return order;
        return std::partial_ordering::equivalent;
    }
    bool operator==(const Corner& other) const { return (*this <=> other) == 0; }
};

// The corners of a face starting from the smallest: the same for every rotation of the face.
struct Key {
    std::array<Corner, 3> corner;
    Id face;
    std::uint8_t first;  // the corner of the face that comes first
};

constexpr std::array<std::uint16_t, 4> kNoColor{};

std::vector<Key> sorted_keys(const StoredMesh& mesh) {
    std::vector<Key> keys(mesh.faces.size());
    for (Id f = 0; f < keys.size(); ++f) {
        std::array<Corner, 3> c;
        for (std::size_t i = 0; i < 3; ++i) {
            const Id v = mesh.faces[f][i];
            c[i] = {mesh.position[v], mesh.color.empty() ? kNoColor : mesh.color[v], &mesh, v};
        }
        const auto first = std::min_element(c.begin(), c.end()) - c.begin();
        std::rotate(c.begin(), c.begin() + first, c.end());
        keys[f] = {c, f, static_cast<std::uint8_t>(first)};
    }
    std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
        return a.corner != b.corner ? a.corner < b.corner : a.face < b.face;
    });
    return keys;
}

std::uint16_t code_of(float light) {
    return static_cast<std::uint16_t>(std::lround(std::clamp(light, 0.0f, 1.0f) * 65535.0f));
}

// Adds the attributes of one more vertex.
void add_features(const float* feature, const StoredLayout& layout, StoredMesh& stored) {
    const std::uint16_t alpha = layout.alpha ? code_of(feature[3 + *layout.alpha]) : 65535;
    if (layout.hdr) {
        const Vec3f light = quantized_hdr(Vec3f(feature));
        stored.hdr.push_back({light[0], light[1], light[2]});
        stored.color.push_back({code_of(light[0]), code_of(light[1]), code_of(light[2]), alpha});
    } else if (layout.color) {
        const auto codes = color_codes(Vec3f(feature));
        stored.color.push_back({codes[0], codes[1], codes[2], alpha});
    }
    if (layout.color) feature += 3;
    for (std::vector<float>& channel : stored.channels) channel.push_back(*feature++);
}

bool is_hdr(const std::array<float, 3>& light) {
    return std::all_of(light.begin(), light.end(), [](float x) { return x >= 0 && x <= kMaxHdr; });
}

}  // namespace

Bounds bounds_of(std::span<const std::array<float, 3>> positions) {
    Bounds bounds{positions.front(), positions.front()};
    for (const auto& p : positions)
        for (std::size_t i = 0; i < 3; ++i) {
            bounds.low[i] = std::min(bounds.low[i], p[i]);
            bounds.high[i] = std::max(bounds.high[i], p[i]);
        }
    return bounds;
}

StoredMesh stored_from_base(const BaseMesh& mesh, const StoredLayout& layout) {
    const auto fail = [](const std::string& what) {
        throw Error(ErrorKind::kInternal, "cannot store the mesh: " + what);
    };
    const std::size_t features = (layout.color ? 3 : 0) + layout.channels;
    if (mesh.channels != static_cast<int>(features) || mesh.feature.size() != features * mesh.vertex_count())
        fail(cat("not ", features, " features a vertex"));
    if (!std::all_of(mesh.feature.begin(), mesh.feature.end(), [](float x) { return std::isfinite(x); }))
        fail("a feature is not finite");
    if (mesh.faces.empty()) fail("it has no faces");
    StoredMesh stored;
    stored.position.reserve(mesh.vertex_count());
    stored.channels.resize(layout.channels);
    for (Id v = 0; v < mesh.vertex_count(); ++v) {
        const Vec2f& p = mesh.position[v];
        if (!on_grid(p.x()) || !on_grid(p.y()))
            fail(cat("vertex ", v, " at (", p.x(), ",", p.y(), ") is not on the grid of 1/32 pixel"));
        // 0 + x and 0 - y are never a negative zero, which would count as another position.
        stored.position.push_back({0.0f + p.x(), 0.0f - p.y(), 0.0f});
        add_features(mesh.feature_of(v), layout, stored);
    }
    for (const Face& face : mesh.faces) {
        if (*std::max_element(face.begin(), face.end()) >= mesh.vertex_count())
            fail("an index is out of range");
        const auto [a, b, c] = corners(mesh, face);
        if (!(signed_area2(a, b, c) > 0)) fail("a face has no area or runs clockwise");
    }
    stored.faces = mesh.faces;
    return stored;
}

BaseMesh base_from_stored(const StoredMesh& mesh, Findings& findings, bool soft) {
    Repeated off_grid(findings, "mesh.position"), alphas(findings, "mesh.color"),
        indices(findings, "mesh.index"), turned(findings, "mesh.orientation"), lights(findings, "mesh.light"),
        values(findings, "mesh.channel");
    const StoredLayout layout = mesh.layout();
    BaseMesh base;
    base.channels = (layout.color ? 3 : 0) + static_cast<int>(layout.channels);
    base.position.reserve(mesh.position.size());
    base.feature.reserve(mesh.position.size() * static_cast<std::size_t>(base.channels));
    for (std::size_t v = 0; v < mesh.position.size(); ++v) {
        const auto& [x, y, z] = mesh.position[v];
        if (!on_grid(x) || !on_grid(y) || z != 0)
            off_grid.hit([&, &x = x, &y = y, &z = z] {
                return std::pair(cat("vertex ", v, " is at (", x, ",", y, ",", z,
                                     "), expected multiples of 1/32 below ", kMaxCoordinate, " and z = 0"),
                                 Place());
            });
        base.position.emplace_back(x, 0.0f - y);
        if (layout.color) {
            const auto& [red, green, blue, alpha] = mesh.color[v];
            if (alpha != 65535 && !soft)
                alphas.hit([&, &alpha = alpha] {
                    return std::pair(cat("vertex ", v, " has alpha ", alpha, ", expected 65535"), Place());
                });
            if (layout.hdr && !is_hdr(mesh.hdr[v]))
                lights.hit([&] {
                    const auto& [r, g, b] = mesh.hdr[v];
                    return std::pair(cat("vertex ", v, " has the HDR colour (", r, ",", g, ",", b,
                                         "), expected 0 to ", kMaxHdr),
                                     Place());
                });
            const Vec3f luv = layout.hdr ? luv_from_linear(Vec3f(mesh.hdr[v].data()))
                                         : color_from_codes({red, green, blue});
            base.feature.insert(base.feature.end(), luv.data(), luv.data() + 3);
        }
        for (std::size_t c = 0; c < layout.channels; ++c) {
            const float value = mesh.channels[c][v];
            if (!std::isfinite(value))
                values.hit(
                    [&] { return std::pair(cat("channel ", c, " of vertex ", v, " is ", value), Place()); });
            base.feature.push_back(value);
        }
    }
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const Face& face = mesh.faces[f];
        const Id largest = *std::max_element(face.begin(), face.end());
        if (largest >= mesh.position.size()) {
            indices.hit([&] {
                return std::pair(
                    cat("face ", f, " has vertex ", largest, ", the mesh has ", mesh.position.size()),
                    Place());
            });
            continue;
        }
        const auto [a, b, c] = corners(base, face);
        if (!(signed_area2(a, b, c) > 0))
            turned.hit([&] { return std::pair(cat("face ", f, " has no area or runs clockwise"), Place()); });
    }
    base.faces = mesh.faces;
    return base;
}

BaseMesh base_from_stored(const StoredMesh& mesh) {
    Findings findings = Findings::strict();
    return base_from_stored(mesh, findings);
}

std::string topology_hash(const StoredMesh& mesh) {
    static_assert(sizeof(Face) == 12 && sizeof(mesh.position[0]) == 12, "no padding");
    const auto bytes = [](const auto& values) {
        return std::span(reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * 12);
    };
    return sha256_hex({bytes(mesh.faces), bytes(mesh.position)});
}

FaceMatch match_faces(const StoredMesh& from, const StoredMesh& to) {
    const std::vector<Key> a = sorted_keys(from), b = sorted_keys(to);
    if (a.size() != b.size())
        throw Error(ErrorKind::kInternal,
                    cat("the stored mesh has ", b.size(), " faces, the mesh has ", a.size()));
    FaceMatch match{std::vector<Id>(a.size()), std::vector<std::uint8_t>(a.size())};
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (a[i].corner != b[i].corner)
            throw Error(ErrorKind::kInternal, cat("face ", a[i].face, " is not in the stored mesh"));
        match.face[a[i].face] = b[i].face;
        match.shift[a[i].face] = static_cast<std::uint8_t>((b[i].first + 3 - a[i].first) % 3);
    }
    return match;
}

void remap_pixels(const FaceMatch& match, PixelMap& map) {
    for (PixelCoord& coord : map) {
        if (coord.face == kNone) continue;
        const std::array<float, 3> weight = {1 - coord.u - coord.v, coord.u, coord.v};
        // The weight of corner c moves to corner (c + shift) % 3.
        const std::size_t shift = match.shift[coord.face];
        coord = {match.face[coord.face], weight[(4 - shift) % 3], weight[(5 - shift) % 3]};
    }
}

}  // namespace imgmesh
