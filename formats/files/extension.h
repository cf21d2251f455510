// The extension of a file name, which tells the kind of file.
#pragma once

#include <string>

namespace imgmesh {

/// Returns the extension of a path's file name, with its dot and in lower case: ".glb" for "a.GLB". Empty if
/// there is none, as for "a" and for the hidden file ".png". Letters beyond ASCII stay.
std::string lower_extension(const std::string& path);

}  // namespace imgmesh
