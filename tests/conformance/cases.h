// The broken containers, by the code of what is broken.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "tests/conformance/sample.h"

namespace imgmesh::conformance {

struct Case {
    Sample sample;
    bool glb = false;
    std::string options;                                      ///< of imgmesh-info
    std::function<void(const std::filesystem::path&)> after;  ///< done to the folder
};

/// Those of the files, the JSON and the extension; those of meshes and of layers as an EXR.
std::map<std::string, Case> json_cases();
std::map<std::string, Case> data_cases();

/// Those of compact layers, by a code and, after a +, which of its cases it is.
std::map<std::string, Case> compact_cases();

/// One for each code.
inline std::map<std::string, Case> all_cases() {
    std::map<std::string, Case> cases = json_cases();
    cases.merge(data_cases());
    return cases;
}

}  // namespace imgmesh::conformance
