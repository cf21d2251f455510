#include "formats/picture/exr_facts.h"

#include <OpenEXR/ImfBoxAttribute.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfRationalAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTimeCodeAttribute.h>
#include <OpenEXR/ImfVecAttribute.h>

#include <algorithm>
#include <cstdint>
#include <optional>

#include "formats/files/one_line.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

using Numbers = std::vector<double>;

// Vectors and matrices: their elements in order.
template <typename V, typename Element>
void take_elements(const V& value, std::size_t count, const Element*, Numbers& out) {
    const Element* const first = reinterpret_cast<const Element*>(&value);
    for (std::size_t i = 0; i < count; ++i) out.push_back(static_cast<double>(first[i]));
}

// One function for each direction, over types whose values are rows of one kind of number.
template <typename Value, typename Element>
struct Plain {
    static constexpr std::size_t kCount =
        sizeof(Value) / sizeof(Element);  // NOLINT(bugprone-sizeof-expression): pointers are no values here
    static bool take(const Imf::Attribute& attribute, Numbers& out) {
        const auto* const typed = dynamic_cast<const Imf::TypedAttribute<Value>*>(&attribute);
        if (!typed) return false;
        take_elements(typed->value(), kCount, static_cast<const Element*>(nullptr), out);
        return true;
    }
    static bool insert(const ExrAttribute& a, Imf::Header& header) {
        if (a.type != Imf::TypedAttribute<Value>::staticTypeName()) return false;
        Value value;
        auto* const first = reinterpret_cast<Element*>(&value);
        for (std::size_t i = 0; i < kCount; ++i) first[i] = static_cast<Element>(a.numbers[i]);
        header.insert(a.name, Imf::TypedAttribute<Value>(value));
        return true;
    }
};

bool take_numbers(const Imf::Attribute& attribute, Numbers& out) {
    if (const auto* const rational = dynamic_cast<const Imf::RationalAttribute*>(&attribute)) {
        out = {double(rational->value().n), double(rational->value().d)};
        return true;
    }
    if (const auto* const time = dynamic_cast<const Imf::TimeCodeAttribute*>(&attribute)) {
        out = {double(time->value().timeAndFlags()), double(time->value().userData())};
        return true;
    }
    if (const auto* const colors = dynamic_cast<const Imf::ChromaticitiesAttribute*>(&attribute)) {
        const Imf::Chromaticities& c = colors->value();
        for (const Imath::V2f& p : {c.red, c.green, c.blue, c.white}) out.insert(out.end(), {p.x, p.y});
        return true;
    }
    return Plain<int, int>::take(attribute, out) || Plain<float, float>::take(attribute, out) ||
           Plain<double, double>::take(attribute, out) || Plain<Imath::V2i, int>::take(attribute, out) ||
           Plain<Imath::V2f, float>::take(attribute, out) || Plain<Imath::V3i, int>::take(attribute, out) ||
           Plain<Imath::V3f, float>::take(attribute, out) || Plain<Imath::Box2i, int>::take(attribute, out) ||
           Plain<Imath::Box2f, float>::take(attribute, out) ||
           Plain<Imath::M33f, float>::take(attribute, out) || Plain<Imath::M44f, float>::take(attribute, out);
}

void insert(const ExrAttribute& a, Imf::Header& header) {
    const Numbers& n = a.numbers;
    const auto point = [&](std::size_t i) {
        return Imath::V2f(static_cast<float>(n[i]), static_cast<float>(n[i + 1]));
    };
    if (a.type == "string")
        header.insert(a.name, Imf::StringAttribute(a.text));
    else if (a.type == "rational")
        header.insert(a.name,
                      Imf::RationalAttribute(Imf::Rational(
                          static_cast<int>(n[0]), static_cast<unsigned>(static_cast<std::int64_t>(n[1])))));
    else if (a.type == "timecode")
        header.insert(a.name, Imf::TimeCodeAttribute(
                                  Imf::TimeCode(static_cast<unsigned>(n[0]), static_cast<unsigned>(n[1]))));
    else if (a.type == "chromaticities")
        header.insert(a.name, Imf::ChromaticitiesAttribute({point(0), point(2), point(4), point(6)}));
    else
        static_cast<void>(
            Plain<int, int>::insert(a, header) || Plain<float, float>::insert(a, header) ||
            Plain<double, double>::insert(a, header) || Plain<Imath::V2i, int>::insert(a, header) ||
            Plain<Imath::V2f, float>::insert(a, header) || Plain<Imath::V3i, int>::insert(a, header) ||
            Plain<Imath::V3f, float>::insert(a, header) || Plain<Imath::Box2i, int>::insert(a, header) ||
            Plain<Imath::Box2f, float>::insert(a, header) || Plain<Imath::M33f, float>::insert(a, header) ||
            Plain<Imath::M44f, float>::insert(a, header));
}

// What every header has and says nothing.
bool is_usual(const Imf::Header& header, const std::string& name) {
    if (name == "displayWindow" || name == "dataWindow")
        return header.displayWindow() == header.dataWindow() && header.displayWindow().min == Imath::V2i(0);
    return (name == "pixelAspectRatio" && header.pixelAspectRatio() == 1) ||
           (name == "screenWindowCenter" && header.screenWindowCenter() == Imath::V2f(0)) ||
           (name == "screenWindowWidth" && header.screenWindowWidth() == 1);
}

std::optional<ExrAttribute> kept(const std::string& name, const Imf::Attribute& attribute) {
    ExrAttribute out{name, attribute.typeName(), {}, {}};
    if (const auto* const text = dynamic_cast<const Imf::StringAttribute*>(&attribute)) {
        if (text->value().size() > kMaxMetadataBytes) return {};
        out.text = text->value();
    } else if (!take_numbers(attribute, out.numbers)) {
        return {};
    }
    if (!exr_attribute_fault(out).empty()) return {};
    return out;
}

}  // namespace

ExrMetadata metadata_of(const Imf::Header& header, bool with_primaries, std::vector<std::string>& warnings) {
    constexpr std::size_t kMaxNamed = 5;
    ExrMetadata out;
    std::string lost;
    std::size_t bytes = 0, count = 0;
    // Numbers first: a long text is not to push a window out.
    for (const bool texts : {false, true}) {
        for (auto it = header.begin(); it != header.end(); ++it) {
            const std::string name = it.name();
            if ((std::string_view(it.attribute().typeName()) == "string") != texts) continue;
            if (is_exr_storage(name) || is_usual(header, name)) continue;
            if (name == "chromaticities" && !with_primaries) continue;
            std::optional<ExrAttribute> attribute = kept(name, it.attribute());
            const std::size_t size = attribute ? exr_attribute_bytes(*attribute) : 0;
            if (attribute && bytes + size <= kMaxMetadataBytes && out.size() < kMaxMetadataEntries) {
                bytes += size;
                out.push_back(std::move(*attribute));
            } else if (++count <= kMaxNamed) {
                lost += cat(count == 1 ? "" : ", ", printable(name));
            }
        }
    }
    std::ranges::sort(out, {}, &ExrAttribute::name);
    if (count > kMaxNamed) lost += cat(" and ", count - kMaxNamed, " more");
    if (count > 0) warnings.push_back(cat("attributes that a container does not keep: ", lost));
    return out;
}

void add_metadata(const ExrMetadata& metadata, Imf::Header& header) {
    for (const ExrAttribute& attribute : metadata)
        if (attribute.name != "displayWindow" && attribute.name != "dataWindow") insert(attribute, header);
}

Imath::Box2i window_of(const ExrAttribute& a) {
    const auto at = [&](std::size_t i) { return static_cast<int>(a.numbers[i]); };
    return {{at(0), at(1)}, {at(2), at(3)}};
}

}  // namespace imgmesh
