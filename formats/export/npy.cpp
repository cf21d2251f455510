// Sources: numpy's "NEP 1, a simple file format for arrays"; PKWARE's APPNOTE.TXT 6.3, sections 4.3.7, 4.3.12
// and 4.3.16.
#include "formats/export/npy.h"

#include <libdeflate.h>

#include <bit>
#include <limits>

#include "formats/files/atomic_file.h"
#include "formats/files/byte_writer.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

using Bytes = std::vector<std::uint8_t>;

void append(Bytes& out, std::string_view text) {
    out.insert(out.end(), text.begin(), text.end());
}

void append_numbers(Bytes& out, std::initializer_list<std::pair<std::uint64_t, int>> numbers) {
    for (const auto& [value, count] : numbers) append_number(out, value, count, ByteOrder::kLittle);
}

// All of an .npy before its data.
Bytes npy_header(const NumpyArray& array) {
    const char order = array.type.front() == 'S'                    ? '|'
                       : std::endian::native == std::endian::little ? '<'
                                                                    : '>';
    std::string shape;
    for (const std::size_t side : array.shape) shape += cat(side, ", ");
    if (array.shape.size() > 1) shape.resize(shape.size() - 2);  // one side keeps its comma: a Python tuple
    if (array.shape.size() == 1) shape.resize(shape.size() - 1);
    std::string text =
        cat("{'descr': '", order, array.type, "', 'fortran_order': False, 'shape': (", shape, "), }");
    constexpr std::size_t kBefore = 10, kAlignment = 64;  // data begin at a multiple of this
    text.resize((kBefore + text.size() + kAlignment) / kAlignment * kAlignment - kBefore - 1, ' ');
    text += '\n';
    Bytes header;
    append(header, "\x93NUMPY\x01");
    append_numbers(header, {{0, 1}, {text.size(), 2}});
    append(header, text);
    return header;
}

// The members that a file in a ZIP and its entry in the directory have alike.
struct Entry {
    std::string name;
    std::uint32_t sum = 0;
    std::uint64_t size = 0, offset = 0;

    void append_common(Bytes& out) const {
        constexpr int kVersion = 20, kStored = 0, kTime = 0, kDate = 1 << 5 | 1;  // 1 January 1980
        append_numbers(out, {{kVersion, 2},
                             {0, 2},
                             {kStored, 2},
                             {kTime, 2},
                             {kDate, 2},
                             {sum, 4},
                             {size, 4},
                             {size, 4},
                             {name.size(), 2},
                             {0, 2}});
    }
};

}  // namespace

void write_npy(const std::string& path, const NumpyArray& array, bool overwrite) {
    AtomicFile file(path, overwrite);
    const Bytes header = npy_header(array);
    const std::span<const std::uint8_t> parts[] = {header, array.bytes};
    file.write_parts(parts);
    file.commit();
}

void write_npz(const std::string& path, std::span<const NumpyArray> arrays, bool overwrite) {
    std::vector<Bytes> headers;
    headers.reserve(arrays.size() + 1);
    std::vector<std::span<const std::uint8_t>> parts;
    Bytes directory;
    std::uint64_t offset = 0;
    for (const NumpyArray& array : arrays) {
        const Bytes npy = npy_header(array);
        const std::uint32_t begun = libdeflate_crc32(0, npy.data(), npy.size());
        const Entry entry{array.name + ".npy",
                          libdeflate_crc32(begun, array.bytes.data(), array.bytes.size()),
                          npy.size() + array.bytes.size(), offset};
        Bytes header;
        append(header, "PK\x03\x04");
        entry.append_common(header);
        append(header, entry.name);
        header.insert(header.end(), npy.begin(), npy.end());
        offset += header.size() + array.bytes.size();
        headers.push_back(std::move(header));
        parts.emplace_back(headers.back());
        parts.push_back(array.bytes);

        constexpr int kMadeBy = 20;
        append(directory, "PK\x01\x02");
        append_numbers(directory, {{kMadeBy, 2}});
        entry.append_common(directory);
        append_numbers(directory, {{0, 2}, {0, 2}, {0, 2}, {0, 4}, {entry.offset, 4}});
        append(directory, entry.name);
    }
    const std::uint64_t size = directory.size();
    append(directory, "PK\x05\x06");
    append_numbers(directory,
                   {{0, 4}, {arrays.size(), 2}, {arrays.size(), 2}, {size, 4}, {offset, 4}, {0, 2}});
    if (offset + directory.size() > std::numeric_limits<std::uint32_t>::max())
        throw Error(ErrorKind::kUnsupported, cat(path, ": an .npz holds at most 4 GB, these arrays take ",
                                                 (offset + directory.size()) >> 20, " MB"));
    parts.emplace_back(directory);
    AtomicFile file(path, overwrite);
    file.write_parts(parts);
    file.commit();
}

}  // namespace imgmesh
