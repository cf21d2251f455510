// A sprite's mesh for Spine: a skeleton with mesh attachments, and the atlas that names the image. The same
// mesh gives the same bytes.
#pragma once

#include <string>

#include "libcore/mesh/disc_part.h"
#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

/// More vertices than Spine's runtimes for the web draw of one attachment.
inline constexpr std::size_t kMostSpineVertices = 10920;

/// Spine's JSON (4.0 to 4.2): one bone in the middle of the image, y up, in pixels; for each part a slot with
/// one mesh attachment whose hull vertices come first. Vertices are kept inside the image.
///
/// parts  disc_parts(mesh) of libcore/mesh/disc_parts.h
/// image  the image file, relative to the JSON; its name without extension is that of the atlas' region
std::string spine_json(const BaseMesh& mesh, const std::vector<DiscPart>& parts, const SourceInfo& source,
                       const std::string& image);

/// The atlas for Spine's runtimes: one page, one region, which is the whole image. Throws Error(kBadArgument)
/// for a name with a control character, which no line can hold.
std::string spine_atlas(const SourceInfo& source, const std::string& image);

}  // namespace imgmesh
