// For clang before 16, included before every test: its lambdas cannot capture structured bindings, and
// doctest's INFO is one. Here the text is written at once, wanted or not.
#pragma once

#include <doctest/doctest.h>

#include <sstream>
#include <string>

namespace imgmesh::test {

struct EagerText {
    std::ostringstream out;

    EagerText& operator<<(const char* text) {
        out << text;
        return *this;
    }
    template <typename T>
    EagerText& operator<<(const T& value) {
        out << doctest::toString(value).c_str();
        return *this;
    }
    /// CAPTURE(x) is INFO(name, x).
    template <typename T>
    EagerText& operator,(const T& value) {
        return *this << value;
    }
};

}  // namespace imgmesh::test

#undef DOCTEST_INFO
#define DOCTEST_INFO(...) IMGMESH_EAGER_INFO(DOCTEST_ANONYMOUS(imgmesh_info_), __VA_ARGS__)
#define IMGMESH_EAGER_INFO(text, ...)                                               \
    const std::string text = (imgmesh::test::EagerText() << __VA_ARGS__).out.str(); \
    const auto DOCTEST_ANONYMOUS(imgmesh_scope_) =                                  \
        doctest::detail::MakeContextScope([&](std::ostream* imgmesh_stream) { *imgmesh_stream << text; })
