// The functions of the class Mesh that give files: bind_mesh.cpp makes them its members.
#pragma once

#include <emscripten/val.h>

#include <string>

#include "web/engine/mesh_value.h"

namespace imgmesh::web {

/// Saves the mesh as a container or a plain glTF asset; returns { name, bytes } of each file, itself first.
emscripten::val save_container(const MeshValue& mesh, const emscripten::val& options);

/// Returns a level as a file of imgmesh-convert's: `format` is ply, obj or json, the sprite of the image file
/// `image`. The bytes are those of imgmesh-convert.
std::string export_text(const MeshValue& mesh, const std::string& format, int level,
                        const std::string& image);

/// Returns { name, bytes } of NAME.obj, NAME.mtl and the image NAME-texture.png or .jpg: a level under a
/// picture, which is the bytes of a PNG or JPEG file or undefined for the one that the container came with.
emscripten::val export_textured(const MeshValue& mesh, const std::string& name, int level,
                                const emscripten::val& picture);

/// Returns the labels of all pixels as a file of the kind that the name says: .png, .tif, .npy, .mat or .exr.
emscripten::val export_labels(const std::string& name, int width, int height, const emscripten::val& labels);

}  // namespace imgmesh::web
