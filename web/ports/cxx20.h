// What imgmesh uses of the C++20 library and emscripten's, of 2021, does not have. Every file that is
// compiled for the web reads it first. It can go once the distribution's emscripten has these.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <type_traits>
#include <version>

#if !defined(__cpp_lib_bit_cast)
namespace std {

template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
    return __builtin_bit_cast(To, from);
}

}  // namespace std
#endif

#if !defined(__cpp_lib_smart_ptr_for_overwrite)
namespace std {

template <class T>
enable_if_t<!is_array_v<T>, unique_ptr<T>> make_unique_for_overwrite() {
    return unique_ptr<T>(new T);
}
template <class T>
enable_if_t<is_array_v<T>, unique_ptr<T>> make_unique_for_overwrite(size_t size) {
    return unique_ptr<T>(new remove_extent_t<T>[size]);
}

}  // namespace std
#endif

#if !defined(__cpp_lib_ranges) || __cpp_lib_ranges < 202110L
// Ranges as wholes, as imgmesh passes them: without views that dangle, and with at most one projection.
namespace std::ranges {

template <class Range, class Value>
auto find(Range&& range, const Value& value) {
    return std::find(std::begin(range), std::end(range), value);
}
template <class Range, class Value, class Projection>
auto find(Range&& range, const Value& value, Projection projection) {
    return std::find_if(std::begin(range), std::end(range),
                        [&](const auto& x) { return std::invoke(projection, x) == value; });
}
template <class Range, class Test>
auto find_if(Range&& range, Test test) {
    return std::find_if(std::begin(range), std::end(range), test);
}
template <class Range, class Value>
auto count(Range&& range, const Value& value) {
    return std::count(std::begin(range), std::end(range), value);
}
template <class Range, class Test>
auto count_if(Range&& range, Test test) {
    return std::count_if(std::begin(range), std::end(range), test);
}
template <class Range, class Test>
bool any_of(Range&& range, Test test) {
    return std::any_of(std::begin(range), std::end(range), [&](auto&& x) { return std::invoke(test, x); });
}
template <class Range, class Test>
bool all_of(Range&& range, Test test) {
    return std::all_of(std::begin(range), std::end(range), [&](auto&& x) { return std::invoke(test, x); });
}
template <class Range, class Test>
bool none_of(Range&& range, Test test) {
    return !ranges::any_of(range, test);
}
template <class Range, class Out>
void copy(Range&& range, Out out) {
    std::copy(std::begin(range), std::end(range), out);
}
template <class Range, class Out, class Change>
void transform(Range&& range, Out out, Change change) {
    std::transform(std::begin(range), std::end(range), out, change);
}
template <class Range, class Other>
bool equal(Range&& range, Other&& other) {
    return std::equal(std::begin(range), std::end(range), std::begin(other), std::end(other));
}
template <class Range, class Old, class New>
void replace(Range&& range, const Old& old_value, const New& new_value) {
    std::replace(std::begin(range), std::end(range), old_value, new_value);
}

// Calls an algorithm of iterators and an order with `less` of the projected values.
template <class Less, class Projection>
auto projected(Less less, Projection projection) {
    return [less, projection](const auto& a, const auto& b) {
        return std::invoke(less, std::invoke(projection, a), std::invoke(projection, b));
    };
}
struct AsItIs {
    template <class T>
    const T& operator()(const T& value) const {
        return value;
    }
};
template <class Range, class Less = std::less<>, class Projection = AsItIs>
auto min_element(Range&& range, Less less = {}, Projection projection = {}) {
    return std::min_element(std::begin(range), std::end(range), projected(less, projection));
}
template <class Range, class Less = std::less<>, class Projection = AsItIs>
auto max_element(Range&& range, Less less = {}, Projection projection = {}) {
    return std::max_element(std::begin(range), std::end(range), projected(less, projection));
}
template <class Range, class Less = std::less<>, class Projection = AsItIs>
void sort(Range&& range, Less less = {}, Projection projection = {}) {
    std::sort(std::begin(range), std::end(range), projected(less, projection));
}
template <class Range, class Less = std::less<>, class Projection = AsItIs>
void stable_sort(Range&& range, Less less = {}, Projection projection = {}) {
    std::stable_sort(std::begin(range), std::end(range), projected(less, projection));
}
template <class Range, class Value, class Less = std::less<>, class Projection = AsItIs>
auto upper_bound(Range&& range, const Value& value, Less less = {}, Projection projection = {}) {
    return std::upper_bound(std::begin(range), std::end(range), value, [&](const auto& v, const auto& x) {
        return std::invoke(less, v, std::invoke(projection, x));
    });
}
template <class Range, class Value, class Less = std::less<>, class Projection = AsItIs>
auto lower_bound(Range&& range, const Value& value, Less less = {}, Projection projection = {}) {
    return std::lower_bound(std::begin(range), std::end(range), value, [&](const auto& x, const auto& v) {
        return std::invoke(less, std::invoke(projection, x), v);
    });
}

}  // namespace std::ranges
#endif

#if !defined(__cpp_lib_to_chars)
namespace std {

// The shortest text that reads back as the same float: with an exponent only where that is shorter.
inline to_chars_result to_chars(char* first, char* last, float value) {
    char digits[32];
    for (int precision = 0; precision < 9; ++precision) {
        snprintf(digits, sizeof digits, "%.*e", precision, static_cast<double>(value));
        if (strtof(digits, nullptr) == value) break;
    }
    string text = digits, fixed;
    if (const auto e = text.find('e'); e != string::npos) {
        const bool negative = text[0] == '-';
        string plain = text.substr(negative ? 1 : 0, e - (negative ? 1 : 0));
        plain.erase(std::remove(plain.begin(), plain.end(), '.'), plain.end());
        const int exponent = atoi(text.c_str() + e + 1), size = static_cast<int>(plain.size());
        if (exponent < 0) {
            fixed = "0." + string(static_cast<size_t>(-exponent - 1), '0') + plain;
        } else if (exponent >= size - 1) {
            fixed = plain + string(static_cast<size_t>(exponent - size + 1), '0');
        } else {
            fixed = plain.substr(0, static_cast<size_t>(exponent) + 1) + "." +
                    plain.substr(static_cast<size_t>(exponent) + 1);
        }
        if (negative) fixed = "-" + fixed;
        if (fixed.size() <= text.size()) text = fixed;
    }
    if (text.size() > static_cast<size_t>(last - first)) return {last, errc::value_too_large};
    return {std::copy(text.begin(), text.end(), first), errc()};
}

}  // namespace std
#endif
