// tinygltf, which Debian has as a library for its own machines alone.
#define TINYGLTF_IMPLEMENTATION
#include <fstream>
#include <nlohmann/json.hpp>

#include <tiny_gltf.h>
