// Draco by its own build for JavaScript (npm's draco3d), which the page loads when a container needs it.
#include "formats/gltf/draco_codec.h"

#include "formats/findings/findings.h"
#include "libcore/base/error.h"
#include "web/ports/script_libraries.h"

namespace imgmesh {
namespace {

using emscripten::val;
using web::script_library;

val draco() {
    const val loaded = script_library("draco").call<val>("loaded");
    if (loaded.isNull())
        throw Error(ErrorKind::kBadArgument,
                    "Draco is not loaded: await loadDraco() before a container is opened or saved with it");
    return loaded;
}

template <typename T>
std::span<const std::uint8_t> bytes_of(const std::vector<T>& values) {
    return {reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(T)};
}

// { id, kind, components, type, bytes }
void add_attribute(val& attributes, std::uint32_t id, const char* kind, int components, const char* type,
                   std::span<const std::uint8_t> bytes) {
    val attribute = val::object();
    attribute.set("id", id);
    attribute.set("kind", std::string(kind));
    attribute.set("components", components);
    attribute.set("type", std::string(type));
    // A copy: views of the module's memory end when it grows.
    attribute.set("bytes", val::global("Uint8Array").new_(web::view_of(bytes)));
    attributes.call<void>("push", attribute);
}

// Fills `out` with the values of all points.
template <typename Value>
void take_values(const val& mesh, std::uint32_t id, const char* kind, int components, const char* type,
                 std::size_t points, std::vector<Value>& out) {
    const val bytes = mesh.call<val>("attribute", id, std::string(kind), components, std::string(type));
    if (bytes.isNull()) refuse("draco.attributes", cat("the Draco mesh has no such attribute with id ", id));
    out.resize(points);
    web::copy_from_script(bytes,
                          std::span(reinterpret_cast<std::uint8_t*>(out.data()), points * sizeof(Value)));
}

}  // namespace

bool draco_takes_predictions() {
    return false;
}

std::vector<std::uint8_t> draco_encode(const StoredMesh& mesh, const DracoAttributeIds& ids, DracoMode mode,
                                       const DracoGrid& grid, const DracoPredictions&) {
    const val coder = draco();
    val attributes = val::array(), task = val::object();
    add_attribute(attributes, ids.position, "position", 3, "float", bytes_of(mesh.position));
    if (ids.color) add_attribute(attributes, *ids.color, "color", 4, "uint16", bytes_of(mesh.color));
    if (ids.hdr) add_attribute(attributes, *ids.hdr, "generic", 3, "float", bytes_of(mesh.hdr));
    for (std::size_t c = 0; c < mesh.channels.size(); ++c)
        add_attribute(attributes, ids.channels[c], "generic", 1, "float", bytes_of(mesh.channels[c]));
    if (ids.texcoord)
        add_attribute(attributes, *ids.texcoord, "texcoord", 2, "float", bytes_of(mesh.texcoord));
    task.set("attributes", attributes);
    task.set("points", mesh.position.size());
    task.set("faces", val::global("Uint8Array").new_(web::view_of(bytes_of(mesh.faces))));
    task.set("edgebreaker", mode == DracoMode::kEdgebreaker);
    task.set("bits", grid.bits);
    val origin = val::array();
    for (const float x : grid.origin) origin.call<void>("push", x);
    task.set("origin", origin);
    task.set("range", grid.range);
    const val bytes = coder.call<val>("encode", task);
    if (bytes.isString())
        throw Error(ErrorKind::kInternal, cat("Draco cannot encode the mesh: ", bytes.as<std::string>()));
    std::vector<std::uint8_t> out(bytes["length"].as<std::size_t>());
    web::copy_from_script(bytes, std::span(out));
    return out;
}

StoredMesh draco_decode(std::span<const std::uint8_t> bytes, const DracoAttributeIds& ids, DracoMode,
                        Findings& findings) {
    const val mesh = draco().call<val>("decode", val::global("Uint8Array").new_(web::view_of(bytes)));
    if (mesh.isString()) refuse("draco.data", cat("Draco cannot decode the mesh: ", mesh.as<std::string>()));
    if (const int found = mesh["attributes"].as<int>(); found != attribute_count(ids))
        refuse("draco.attributes",
               cat("the Draco mesh has ", found, " attributes, expected ", attribute_count(ids)));
    const auto points = mesh["points"].as<std::size_t>(),
               faces = mesh["faces"]["length"].as<std::size_t>() / 3;
    StoredMesh out;
    take_values(mesh, ids.position, "position", 3, "float", points, out.position);
    if (ids.color) take_values(mesh, *ids.color, "color", 4, "uint16", points, out.color);
    if (ids.hdr) take_values(mesh, *ids.hdr, "generic", 3, "float", points, out.hdr);
    for (const std::uint32_t id : ids.channels)
        take_values(mesh, id, "generic", 1, "float", points, out.channels.emplace_back());
    if (ids.texcoord) take_values(mesh, *ids.texcoord, "texcoord", 2, "float", points, out.texcoord);
    out.faces.resize(faces);
    if (faces > 0) web::copy_from_script(mesh["faces"], std::span(out.faces[0].data(), 3 * faces));
    for (std::size_t f = 0; f < faces; ++f)
        for (const Id corner : out.faces[f])
            if (corner >= points)
                refuse("mesh.index", cat("face ", f, " has vertex ", corner, ", the mesh has ", points));
    (void)findings;
    return out;
}

}  // namespace imgmesh
