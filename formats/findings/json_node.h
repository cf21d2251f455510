// JSON of which every member is checked: a value and its place, for files that a reader takes whole or not at
// all. Internal to the readers.
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "formats/findings/json_parse.h"
#include "libcore/base/error.h"

namespace imgmesh {

/// Parses the text of the file `name`. Throws Error(kBadFile) for text that is over the limits or no JSON, or
/// has a member twice, one of which would be lost.
nlohmann::json whole_json(std::string_view text, const std::string& name, const JsonLimits& limits);

/// A value and its place, as "edits.json: /edits/0". Whatever is not as expected throws Error(kBadFile) with
/// that place.
class JsonNode {
  public:
    JsonNode(const nlohmann::json& value, std::string place) : value_(value), place_(std::move(place)) {}

    const std::string& place() const { return place_; }
    [[noreturn]] void refuse(const std::string& text) const {
        throw Error(ErrorKind::kBadFile, cat(place_, ": ", text));
    }

    bool has(const char* name) const { return value_.contains(name); }
    JsonNode operator[](const char* name) const { return {value_.at(name), place_ + '/' + name}; }
    /// The member `name`, which must be there.
    JsonNode member(const char* name) const;
    /// The elements of an array of `least` to `most`.
    std::vector<JsonNode> items(std::size_t least, std::size_t most) const;
    std::vector<JsonNode> items() const { return items(0, std::numeric_limits<std::size_t>::max()); }

    /// Checks that this is an object with no other members than these.
    void check_members(std::initializer_list<const char*> names) const;
    double number(double least, double most) const;
    std::int64_t whole(std::int64_t most) const;
    std::string text() const;

    bool is_number() const { return value_.is_number(); }
    bool is_true() const { return value_.is_boolean() && value_.get<bool>(); }
    bool is_text(const char* text) const {
        return value_.is_string() && value_.get_ref<const std::string&>() == text;
    }
    const nlohmann::json& value() const { return value_; }

  private:
    const nlohmann::json& value_;
    std::string place_;
};

}  // namespace imgmesh
