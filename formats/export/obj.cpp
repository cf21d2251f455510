// Sources: the OBJ and MTL formats, Wavefront Advanced Visualizer, appendix B1. A file's name reaches to the
// end of its line, spaces included, as Blender, assimp and three.js read it.
#include "formats/export/obj.h"

#include <algorithm>

#include "formats/export/text_numbers.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

std::string line_name(const std::string& name) {
    if (std::any_of(name.begin(), name.end(), [](unsigned char c) { return c < 32 || c == 127; }))
        throw Error(ErrorKind::kBadArgument, "the name of an .obj's file has a control character");
    // A hyphen would begin an option, and # a comment.
    return name.starts_with('-') || name.starts_with('#') ? "./" + name : name;
}

}  // namespace

std::string textured_obj(const BaseMesh& mesh, std::span<const Vec2f> coords, const std::string& mtl) {
    std::string out = "# imgmesh: pixels, y up\nmtllib " + line_name(mtl) + "\nusemtl image\n";
    for (const Vec2f& p : mesh.position)
        out += "v " + number_text(p.x()) + ' ' + number_text(-p.y()) + " 0\n";
    for (const Vec2f& c : coords) out += "vt " + number_text(c.x()) + ' ' + number_text(1 - c.y()) + '\n';
    for (const auto& [a, b, c] : mesh.faces)
        out += cat("f ", a + 1, '/', a + 1, ' ', b + 1, '/', b + 1, ' ', c + 1, '/', c + 1, '\n');
    return out;
}

std::string mtl_of_texture(const std::string& image, bool transparent) {
    const std::string name = line_name(image);
    std::string out = "newmtl image\nKa 1 1 1\nKd 1 1 1\nKs 0 0 0\nillum 1\nmap_Kd " + name + '\n';
    if (transparent) out += "map_d " + name + '\n';
    return out;
}

}  // namespace imgmesh
