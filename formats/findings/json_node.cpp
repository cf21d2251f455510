#include "formats/findings/json_node.h"

#include <algorithm>

#include "formats/findings/findings.h"

namespace imgmesh {

using nlohmann::json;

json whole_json(std::string_view text, const std::string& name, const JsonLimits& limits) {
    Findings findings = Findings::collecting();
    json document;
    std::string refusal;
    try {
        document = parse_json(text, limits, findings);
        // In a container a duplicate member is a warning; here one of the two would be lost.
        for (const Issue& issue : findings.issues())
            if (issue.finding->code == std::string_view("json.duplicate")) refusal = issue.text;
    } catch (const FindingError& error) {
        refusal = cat(error.code() == "json.syntax" ? "no JSON: " : "", error.what());
    }
    if (!refusal.empty()) throw Error(ErrorKind::kBadFile, cat(name, ": ", refusal));
    return document;
}

JsonNode JsonNode::member(const char* name) const {
    if (!value_.is_object() || !has(name)) refuse(cat("member \"", name, "\" is missing"));
    return (*this)[name];
}

std::vector<JsonNode> JsonNode::items(std::size_t least, std::size_t most) const {
    if (!value_.is_array()) refuse(cat("expected an array, found ", value_.type_name()));
    if (value_.size() < least || value_.size() > most)
        refuse(least == most ? cat("expected ", least, " items, found ", value_.size())
                             : cat("expected at least ", least, " item, found none"));
    std::vector<JsonNode> all;
    all.reserve(value_.size());
    for (std::size_t i = 0; i < value_.size(); ++i)
        all.emplace_back(value_[i], place_ + '/' + std::to_string(i));
    return all;
}

void JsonNode::check_members(std::initializer_list<const char*> names) const {
    if (!value_.is_object()) refuse(cat("expected an object, found ", value_.type_name()));
    for (const auto& [name, ignored] : value_.items())
        if (std::find(names.begin(), names.end(), name) == names.end())
            refuse(cat("unknown member ", json(name).dump(-1, ' ', true, json::error_handler_t::replace)));
}

double JsonNode::number(double least, double most) const {
    if (!value_.is_number()) refuse(cat("expected a number, found ", value_.type_name()));
    const auto number = value_.get<double>();
    if (!(number >= least && number <= most))
        refuse(cat("expected a number from ", least, " to ", most, ", found ", number));
    return number;
}

std::int64_t JsonNode::whole(std::int64_t most) const {
    if (!value_.is_number()) refuse(cat("expected a whole number, found ", value_.type_name()));
    const auto number = value_.get<double>();
    // A schema counts 2.0 as a whole number, and so does this.
    if (!(number >= 0 && number <= double(most)) || number != std::floor(number))
        refuse(cat("expected a whole number from 0 to ", most, ", found ", value_.dump()));
    return value_.is_number_integer() ? value_.get<std::int64_t>() : static_cast<std::int64_t>(number);
}

std::string JsonNode::text() const {
    if (!value_.is_string()) refuse(cat("expected a string, found ", value_.type_name()));
    return value_.get<std::string>();
}

}  // namespace imgmesh
