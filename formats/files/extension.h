// What kind of file a name stands for.
#pragma once

#include <string>

namespace imgmesh {

/// The extension of a path's file name, with its dot and in lower case: ".glb" for "a.GLB". Empty where
/// there is none, as for "a" and for ".png", a hidden file. Letters beyond ASCII stay as they are.
std::string lower_extension(const std::string& path);

}  // namespace imgmesh
