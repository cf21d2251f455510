// Names of sidecar files as relative URIs (RFC 3986).
#pragma once

#include <string>

namespace imgmesh {

/// Percent-encodes a file name: everything except A-Z a-z 0-9 - . _ ~. Throws Error(kBadArgument) for a name
/// that name_from_uri() would refuse.
std::string uri_from_name(const std::string& name);

/// Returns the file name of a URI. Throws FindingError("uri.name") for anything except a bare name: an empty
/// URI, a path (/ or \, escaped or not), a scheme, a query, a fragment, "." and "..", control characters, a
/// broken escape.
std::string name_from_uri(const std::string& uri);

}  // namespace imgmesh
