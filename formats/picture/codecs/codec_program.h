// Where imgmesh's program of codecs is.
#pragma once

#include <string>

namespace imgmesh {

/// The program's absolute path; empty if it is not installed. It is looked for, in this order, where the
/// package says that a program of another project was linked to (imgmesh_linked_codecs), beside the running
/// program as an installation lays them out, and where this build was to be installed; never along PATH, in
/// the working folder or where an environment variable points.
std::string find_codec_program();

}  // namespace imgmesh

/// Defined in programs that are linked through the installed package (codecs_path.cpp there), null in others.
extern "C" const char* imgmesh_linked_codecs() __attribute__((weak));
