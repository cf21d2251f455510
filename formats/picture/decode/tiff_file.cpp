#include "formats/picture/decode/tiff_file.h"

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstring>

#include "formats/files/one_line.h"

namespace imgmesh {
namespace {

constexpr std::size_t kMostWarnings = 20;

std::string text_of_message(const char* format, std::va_list values) {
    std::array<char, 400> text{};
    std::vsnprintf(text.data(), text.size(), format, values);
    return one_line(text.data());
}

}  // namespace

struct TiffFile::Callbacks {
    static TiffFile& self(void* file) { return *static_cast<TiffFile*>(file); }

    static tmsize_t read(thandle_t file, void* out, tmsize_t count) {
        TiffFile& f = self(file);
        if (count <= 0) return 0;
        try {
            const std::size_t n =
                f.read_at(f.at_, {static_cast<std::uint8_t*>(out), static_cast<std::size_t>(count)});
            f.at_ += n;
            return static_cast<tmsize_t>(n);
        } catch (const Error& error) {  // no exception goes through libtiff
            if (f.error_.empty()) f.error_ = error.what();
            return -1;
        }
    }
    static tmsize_t write(thandle_t, void*, tmsize_t) { return 0; }
    static toff_t seek(thandle_t file, toff_t to, int whence) {
        TiffFile& f = self(file);
        const toff_t from = whence == SEEK_CUR ? f.at_ : whence == SEEK_END ? f.size() : 0;
        return f.at_ = from + to;  // a place beyond the end gives no bytes
    }
    static int close(thandle_t) { return 0; }
    static toff_t size(thandle_t file) { return self(file).size(); }
    // libtiff only reads what it is given here, and checks each place against the size.
    static int map(thandle_t file, void** base, toff_t* count) {
        const TiffFile& f = self(file);
        if (f.file_) return 0;
        *base = const_cast<std::uint8_t*>(f.bytes_.data());
        *count = f.bytes_.size();
        return 1;
    }
    static void unmap(thandle_t, void*, toff_t) {}

    static int on_error(TIFF*, void* file, const char*, const char* format, std::va_list values) {
        TiffFile& f = self(file);
        if (f.error_.empty()) f.error_ = text_of_message(format, values);
        return 1;
    }
    static int on_warning(TIFF*, void* file, const char*, const char* format, std::va_list values) {
        TiffFile& f = self(file);
        if (f.warnings_.size() < kMostWarnings) f.warnings_.push_back(text_of_message(format, values));
        return 1;
    }
};

TiffFile::TiffFile(const std::string& path, std::span<const std::uint8_t> bytes)
    : path_(path), bytes_(bytes) {
    open("r");
}

// O: offsets and lengths of blocks are read when they are asked for.
TiffFile::TiffFile(const RandomFile& file) : path_(file.path()), file_(&file) {
    open("rO");
}

void TiffFile::open(const char* mode) {
    const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(TIFFOpenOptionsAlloc(),
                                                                               TIFFOpenOptionsFree);
    if (!options) throw std::bad_alloc();
    TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), tmsize_t{kMostAtOnce});
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), Callbacks::on_error, this);
    TIFFOpenOptionsSetWarningHandlerExtR(options.get(), Callbacks::on_warning, this);
    tiff_.reset(TIFFClientOpenExt("image", mode, this, Callbacks::read, Callbacks::write, Callbacks::seek,
                                  Callbacks::close, Callbacks::size, Callbacks::map, Callbacks::unmap,
                                  options.get()));
    if (!tiff_) throw broken("cannot read the TIFF");
}

std::size_t TiffFile::read_at(std::uint64_t at, std::span<std::uint8_t> out) const {
    if (file_) return file_->read_at(at, out);
    if (at >= bytes_.size()) return 0;
    const std::size_t n = std::min<std::size_t>(out.size(), bytes_.size() - at);
    std::memcpy(out.data(), bytes_.data() + at, n);
    return n;
}

std::vector<std::uint8_t> TiffFile::bytes_at(std::uint64_t at, std::size_t most) const {
    const std::uint64_t left = size() - std::min(size(), at);
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(std::min<std::uint64_t>(left, most)));
    bytes.resize(read_at(at, bytes));
    return bytes;
}

void TiffFile::forget_messages() {
    error_.clear();
    warnings_.clear();
}

Error TiffFile::broken(const std::string& what) const {
    return Error(ErrorKind::kBadFile, cat(path_, ": ", what, error_.empty() ? "" : ": ", error_));
}

Error TiffFile::unsupported(const std::string& what) const {
    return Error(ErrorKind::kUnsupported, cat(path_, ": ", what));
}

}  // namespace imgmesh
