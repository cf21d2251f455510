// Members of JSON objects that must exist and have a type; internal to the reader.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "formats/findings/finding_error.h"
#include "libcore/base/error.h"

namespace imgmesh {

inline const nlohmann::json* find(const nlohmann::json& object, const char* name) {
    const auto it = object.is_object() ? object.find(name) : object.end();
    return object.is_object() && it != object.end() ? &*it : nullptr;
}

inline const nlohmann::json& member(const nlohmann::json& object, const char* name, FindingCode code) {
    const nlohmann::json* value = find(object, name);
    if (!value) refuse(code, cat("member \"", name, "\" is missing"));
    return *value;
}

inline std::uint64_t unsigned_member(const nlohmann::json& object, const char* name, FindingCode code) {
    const nlohmann::json& value = member(object, name, code);
    if (!value.is_number_unsigned())
        refuse(code, cat("\"", name, "\" is not a whole number >= 0"), at_pointer(name));
    return value.get<std::uint64_t>();
}

inline std::string string_member(const nlohmann::json& object, const char* name, FindingCode code) {
    const nlohmann::json& value = member(object, name, code);
    if (!value.is_string()) refuse(code, cat("\"", name, "\" is not a string"), at_pointer(name));
    return value.get<std::string>();
}

/// Returns a member's name as a token of a JSON pointer.
inline std::string pointer_token(const std::string& name) {
    std::string token;
    for (const char c : name) token += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
    return token;
}

}  // namespace imgmesh
