// One level of a container in another program's format; for imgmesh-convert.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "formats/container/container.h"
#include "libcore/mesh/mesh_image.h"
#include "libcore/mesh/outline.h"
#include "tools/common/choices.h"

namespace imgmesh {

struct Context;

enum class Shading { kFlat, kGradient };

/// What an extension that several programs share stands for.
enum class ExportKind { kTexturePacker, kSpine, kOutline, kPolygon2d, kMeshInstance2d };
const Choices<ExportKind>& export_kinds();

struct LevelOptions {
    std::string input, output;
    std::optional<ExportKind> as;
    std::optional<Shading> shading;
    std::optional<double> outline_tolerance;
    OutlineSide outline_side = OutlineSide::kOut;
    std::string image;  ///< the name in a sprite's file; empty for the output's in .png
};

/// Whether export_level() writes files of this name's extension.
bool is_level_file(const std::string& output);

/// What the extension stands for: `as`, or else the extension's usual one; none for extensions that stand for
/// one thing. Throws Error(kBadArgument) for an `as` that the extension cannot be.
std::optional<ExportKind> export_kind(const LevelOptions& options);

/// The files of an export, itself first. An .obj with a texture has two beside it. Its image is not named as
/// the .obj, as the image that the mesh was made from often is.
///
/// texture  the texture's file, for an .obj; none without one
std::vector<std::string> level_files(const LevelOptions& options, const Texture* texture);

/// Writes level `index` as `options` says: all of level_files(), or none.
///
/// texture  for an .obj, with the coordinates of all levels; none for the colours of vertices. The positions
///          then belong to it; else they are moved to the outer edge of their pixels here
/// Throws Error(kUnsupported) for a mesh that the format cannot show, and as writers do.
void export_level(const LevelOptions& options, const MeshImage& mesh_image, int index, const Texture* texture,
                  Context& context);

}  // namespace imgmesh
