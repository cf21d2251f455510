// Sources: Godot 3.2, "TSCN file format"; scene/2d/polygon_2d.cpp, scene/resources/mesh.cpp and
// servers/visual_server.h, for what an ArrayMesh's bytes are.
#include "formats/export/godot.h"

#include <algorithm>
#include <array>
#include <bit>

#include "formats/export/text_numbers.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (static_cast<unsigned char>(c) < 32 || c == 127)
            throw Error(ErrorKind::kBadArgument, "the name of a scene's file has a control character");
        if (c == '"' || c == '\\') out += '\\';
        out += c;
    }
    return out + '"';
}

// A node's name may have none of these; Godot would replace them with a warning.
std::string node_name(std::string name) {
    for (char& c : name)
        if (std::string_view(".:@/\"%").find(c) != std::string_view::npos) c = '_';
    return name.empty() ? "image" : name;
}

std::string head(int resources, const std::string& image) {
    return cat("[gd_scene load_steps=", resources + 1, " format=2]\n\n[ext_resource path=", quoted(image),
               " type=\"Texture\" id=1]\n\n");
}

std::string polygon(const BaseMesh& mesh, const DiscPart& part, const SourceInfo& source) {
    const std::string points = joined_text(part.vertex.size(), ", ", [&](std::size_t i) {
        const Vec2f& p = mesh.position[part.vertex[i]];
        return number_text(from_corner(p.x(), source.width)) + ", " +
               number_text(from_corner(p.y(), source.height));
    });
    const std::string triangles = joined_text(part.faces.size(), ", ", [&](std::size_t i) {
        const auto& [a, b, c] = part.faces[i];
        return cat("PoolIntArray( ", a, ", ", b, ", ", c, " )");
    });
    return cat("texture = ExtResource( 1 )\npolygon = PoolVector2Array( ", points,
               " )\nuv = PoolVector2Array( ", points, " )\npolygons = [ ", triangles,
               " ]\ninternal_vertex_count = ", part.vertex.size() - part.hull, '\n');
}

// Bytes in the order of the machine that Godot exports for: little endian.
template <typename Value>
void append_bytes(std::string& out, Value value) {
    static_assert(std::endian::native == std::endian::little);
    for (const unsigned char byte : std::bit_cast<std::array<unsigned char, sizeof(Value)>>(value))
        out += (out.empty() ? "" : ", ") + std::to_string(byte);
}

}  // namespace

std::string godot_polygons(const BaseMesh& mesh, const std::vector<DiscPart>& parts, const SourceInfo& source,
                           const std::string& image, const std::string& name) {
    std::string out = head(1, image);
    const std::string root = quoted(node_name(name));
    if (parts.size() == 1)
        return out + cat("[node name=", root, " type=\"Polygon2D\"]\n") + polygon(mesh, parts[0], source);
    out += cat("[node name=", root, " type=\"Node2D\"]\n");
    for (std::size_t i = 0; i < parts.size(); ++i)
        out += cat("\n[node name=\"part", i + 1, "\" type=\"Polygon2D\" parent=\".\"]\n") +
               polygon(mesh, parts[i], source);
    return out;
}

std::string godot_mesh(const BaseMesh& mesh, const SourceInfo& source, const std::string& image,
                       const std::string& name) {
    // The formats of VisualServer: vertices, texture coordinates, indices; vertices are 2D.
    constexpr int kFormat = 1 << 0 | 1 << 4 | 1 << 8 | 1 << 18, kTriangles = 4;
    constexpr std::size_t kShortIndices = 1 << 16;  // fewer vertices than this have indices of 16 bits
    std::string vertices, indices;
    for (const Vec2f& p : mesh.position) {
        const float x = from_corner(p.x(), source.width), y = from_corner(p.y(), source.height);
        for (const float value :
             {x, y, x / static_cast<float>(source.width), y / static_cast<float>(source.height)})
            append_bytes(vertices, value);
    }
    for (const auto& [a, b, c] : mesh.faces)
        // Clockwise is Godot's front.
        for (const Id v : {a, c, b}) {
            if (mesh.vertex_count() < kShortIndices)
                append_bytes(indices, static_cast<std::uint16_t>(v));
            else
                append_bytes(indices, std::uint32_t{v});
        }
    return cat(head(2, image),
               "[sub_resource type=\"ArrayMesh\" id=1]\nsurfaces/0 = {\n\"aabb\": AABB( 0, 0, 0, ",
               source.width, ", ", source.height, ", 0 ),\n\"array_data\": PoolByteArray( ", vertices,
               " ),\n\"array_index_data\": PoolByteArray( ", indices,
               " ),\n\"blend_shape_data\": [  ],\n\"format\": ", kFormat,
               ",\n\"index_count\": ", 3 * mesh.faces.size(), ",\n\"primitive\": ", kTriangles,
               ",\n\"skeleton_aabb\": [  ],\n\"vertex_count\": ", mesh.vertex_count(),
               "\n}\n\n[node name=", quoted(node_name(name)),
               " type=\"MeshInstance2D\"]\nmesh = SubResource( 1 )\ntexture = ExtResource( 1 )\n");
}

}  // namespace imgmesh
