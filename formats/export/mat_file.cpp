// Source: MathWorks' "MAT-File Format", chapter "Level 5 MAT-File Format".
#include "formats/export/mat_file.h"

#include <libdeflate.h>

#include <algorithm>
#include <bit>
#include <memory>
#include <new>
#include <string_view>
#include <vector>

#include "formats/files/atomic_file.h"
#include "formats/files/byte_writer.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Types of data elements.
enum ElementType : std::uint8_t {
    kInt8 = 1,
    kUint16Data = 4,
    kInt32 = 5,
    kUint32Data = 6,
    kSingleData = 7,
    kDoubleData = 9,
    kMatrix = 14,
    kCompressed = 15
};

constexpr std::uint8_t kCellClass = 1;
constexpr std::size_t kTag = 8;  // bytes: a type and the number of bytes that follow
constexpr std::uint64_t kMost = (std::uint64_t{1} << 31) - 1;  // bytes of a variable that MATLAB reads

// Numbers stand in the order that the header names, which is this machine's.
constexpr ByteOrder kOrder = std::endian::native == std::endian::big ? ByteOrder::kBig : ByteOrder::kLittle;

std::size_t bytes_of_one(MatType type) {
    return type == MatType::kDouble ? 8 : type == MatType::kUint16 ? 2 : 4;
}

std::size_t data_size(const MatVariable& v) {
    return v.rows * v.columns * bytes_of_one(v.type);
}

ElementType data_type(MatType type) {
    switch (type) {
        case MatType::kDouble:
            return kDoubleData;
        case MatType::kSingle:
            return kSingleData;
        case MatType::kUint16:
            return kUint16Data;
        case MatType::kUint32:
            return kUint32Data;
    }
    throw Error(ErrorKind::kInternal, "unknown class of a MATLAB matrix");
}

std::size_t padded(std::size_t size) {
    return (size + 7) / 8 * 8;
}

void append_tag(Bytes& out, ElementType type, std::size_t size) {
    append_number(out, type, 4, kOrder);
    append_number(out, size, 4, kOrder);
}

// An element of `size` bytes, which `fill` writes. Four bytes or less stand in the tag itself, as MATLAB has
// it.
void append_element(Bytes& out, ElementType type, std::size_t size,
                    const std::function<void(std::uint8_t*)>& fill) {
    if (size > 0 && size <= 4)
        append_number(out, size << 16 | type, 4, kOrder);
    else
        append_tag(out, type, size);
    const std::size_t at = out.size();
    out.resize(padded(at + size));
    fill(out.data() + at);
}

std::size_t element_size(std::size_t bytes) {
    return bytes > 0 && bytes <= 4 ? kTag : kTag + padded(bytes);
}

// What all arrays begin with: class, sides and name.
void append_head(Bytes& out, std::uint8_t array_class, std::size_t rows, std::size_t columns,
                 const std::string& name) {
    append_tag(out, kUint32Data, 8);
    append_number(out, array_class, 4, kOrder);
    append_number(out, 0, 4, kOrder);
    append_tag(out, kInt32, 8);
    append_number(out, rows, 4, kOrder);
    append_number(out, columns, 4, kOrder);
    append_element(out, kInt8, name.size(),
                   [&](std::uint8_t* to) { std::copy(name.begin(), name.end(), to); });
}

std::size_t head_size(const std::string& name) {
    return 2 * (kTag + 8) + element_size(name.size());
}

// The variable as an element of its own, not compressed.
Bytes variable_element(const MatVariable& v) {
    const std::string inner = v.in_cell ? "" : v.name;
    const std::size_t matrix = head_size(inner) + element_size(data_size(v));
    Bytes out;
    out.reserve(matrix + head_size(v.name) + 2 * kTag);
    if (v.in_cell) {
        append_tag(out, kMatrix, head_size(v.name) + kTag + matrix);
        append_head(out, kCellClass, 1, 1, v.name);
    }
    append_tag(out, kMatrix, matrix);
    append_head(out, static_cast<std::uint8_t>(v.type), v.rows, v.columns, inner);
    append_element(out, data_type(v.type), data_size(v), v.fill);
    return out;
}

Bytes file_header() {
    constexpr std::size_t kText = 116, kSubsystem = 8;
    constexpr std::string_view kWords = "MATLAB 5.0 MAT-file, written by imgmesh";
    Bytes out(kWords.begin(), kWords.end());
    out.resize(kText, ' ');
    out.resize(kText + kSubsystem, 0);
    append_number(out, 0x0100, 2, kOrder);
    append_number(out, 'M' << 8 | 'I', 2, kOrder);
    return out;
}

}  // namespace

void write_mat(const std::string& path, std::span<const MatVariable> variables, bool overwrite) {
    constexpr int kLevel = 6;  // as zlib's usual one
    for (const MatVariable& v : variables)
        if (data_size(v) > kMost - 1024)
            throw Error(ErrorKind::kUnsupported, cat(path, ": a variable of a .mat takes at most 2 GB, ",
                                                     v.name, " would take ", data_size(v) >> 20, " MB"));
    const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> packer(
        libdeflate_alloc_compressor(kLevel), libdeflate_free_compressor);
    if (!packer) throw std::bad_alloc();
    AtomicFile file(path, overwrite);
    std::vector<Bytes> heads = {file_header()};
    std::vector<std::unique_ptr<std::uint8_t[]>> packed;
    std::vector<std::size_t> sizes;
    for (const MatVariable& v : variables) {
        const Bytes element = variable_element(v);
        const std::size_t most = libdeflate_zlib_compress_bound(packer.get(), element.size());
        packed.push_back(std::make_unique_for_overwrite<std::uint8_t[]>(most));  // most of it stays untouched
        sizes.push_back(libdeflate_zlib_compress(packer.get(), element.data(), element.size(),
                                                 packed.back().get(), most));
        append_tag(heads.emplace_back(), kCompressed, sizes.back());
    }
    std::vector<std::span<const std::uint8_t>> parts = {heads[0]};
    for (std::size_t k = 0; k < packed.size(); ++k) {
        parts.emplace_back(heads[k + 1]);
        parts.emplace_back(packed[k].get(), sizes[k]);
    }
    file.write_parts(parts);
    file.commit();
}

}  // namespace imgmesh
