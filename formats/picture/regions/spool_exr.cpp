#include "formats/picture/regions/spool_exr.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTileDescription.h>
#include <OpenEXR/ImfTiledOutputPart.h>

#include <algorithm>
#include <optional>

#include "formats/exr/file_input.h"
#include "formats/files/atomic_file.h"
#include "formats/files/library_error.h"
#include "formats/picture/regions/decoded_regions.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

using Imath::Box2i;

constexpr int kTileSide = 256, kLeastLines = 16;

// Writes what OpenEXR gives. Its destructors swallow what is thrown, so a failure is kept, too.
class FileOutput : public Imf::OStream {
  public:
    explicit FileOutput(AtomicFile& file) : OStream("copy"), file_(file) {}
    void write(const char* in, int count) override {
        try {
            const auto* const bytes = reinterpret_cast<const std::uint8_t*>(in);
            file_.write_at(at_, {bytes, static_cast<std::size_t>(count)});
        } catch (const Error& error) {
            if (!failure_) failure_ = error;
            throw;
        }
        at_ += static_cast<std::uint64_t>(count);
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t at) override { at_ = at; }
    void check() const {
        if (failure_) throw Error(*failure_);
    }

  private:
    AtomicFile& file_;
    std::uint64_t at_ = 0;
    std::optional<Error> failure_;
};

// The lines of a part from one file, opened again where they break.
class LineSource {
  public:
    LineSource(const std::string& path, const ReadImageOptions& options)
        : options_(options), file_(path), stream_(file_) {
        open();
    }

    const ExrPicture& picture() const { return *picture_; }

    // Returns false if a chunk is broken.
    bool read(const Imf::FrameBuffer& buffer, int first, int last) {
        try {
            if (!part_) part_.emplace(picture_->file(), picture_->part());
            part_->setFrameBuffer(buffer);
            part_->readPixels(first, last);
            return true;
        } catch (const Error&) {  // of the system
            throw;
        } catch (const std::bad_alloc&) {
            throw;
        } catch (const std::exception& error) {
            if (broken_.empty()) broken_ = one_line(error.what());
        }
        part_.reset();
        open();
        return false;
    }
    const std::string& broken() const { return broken_; }  ///< the first reason

  private:
    void open() {
        stream_.seekg(0);
        picture_.emplace(file_.path(), stream_, options_, source_limits(options_, file_.size()));
    }

    const ReadImageOptions& options_;
    RandomFile file_;
    FileInput stream_;
    std::optional<ExrPicture> picture_;
    std::optional<Imf::InputPart> part_;
    std::string broken_;
};

std::size_t bytes_of(Imf::PixelType type) {
    return type == Imf::HALF ? 2 : 4;
}

// Some lines of a part, in the types of their channels.
class LineBuffer {
  public:
    LineBuffer(const ExrPicture& picture, int lines) : stored_(picture.header().dataWindow()) {
        for (const ExrChannel& channel : picture.channels()) {
            const std::size_t row = bytes_of(channel.type) * static_cast<std::size_t>(width());
            rows_.push_back(
                {channel.full, channel.type, row, std::vector<char>(row * static_cast<std::size_t>(lines))});
        }
    }

    int width() const { return stored_.max.x - stored_.min.x + 1; }

    // For OpenEXR, which wants the address of pixel (0, 0): the lines from `top` on.
    Imf::FrameBuffer at(int top) {
        Imf::FrameBuffer buffer;
        for (Channel& c : rows_) {
            const auto step = static_cast<std::ptrdiff_t>(bytes_of(c.type));
            char* const origin =
                c.samples.data() - step * stored_.min.x - static_cast<std::ptrdiff_t>(c.row_bytes) * top;
            buffer.insert(c.name, Imf::Slice(c.type, origin, static_cast<std::size_t>(step), c.row_bytes));
        }
        return buffer;
    }

  private:
    struct Channel {
        std::string name;
        Imf::PixelType type;
        std::size_t row_bytes;
        std::vector<char> samples;
    };

    Box2i stored_;
    std::vector<Channel> rows_;
};

int tile_lines(const ExrPicture& picture) {
    constexpr std::int64_t kRowOfTiles = std::int64_t{32} << 20;  // bytes
    const ExrBlock& block = picture.block();
    const std::int64_t lines = kRowOfTiles / std::max<std::int64_t>(1, block.bytes / block.height);
    return static_cast<int>(
        std::clamp<std::int64_t>(lines / kLeastLines * kLeastLines, kLeastLines, kTileSide));
}

std::vector<Imf::Header> headers_of_copy(const ExrPicture& picture, int lines) {
    std::vector<Imf::Header> headers;
    for (int i = 0; i < picture.file().parts(); ++i) headers.push_back(picture.file().header(i));
    Imf::Header& own = headers[static_cast<std::size_t>(picture.part())];
    own.setType(Imf::TILEDIMAGE);
    own.setTileDescription({kTileSide, static_cast<unsigned>(lines), Imf::ONE_LEVEL});
    own.lineOrder() = Imf::RANDOM_Y;  // others wait for tiles that are left out
    // Channels of zeros take no place then.
    std::size_t channels = 0;
    for (auto it = own.channels().begin(); it != own.channels().end(); ++it) ++channels;
    own.compression() = channels == picture.channels().size() ? Imf::NO_COMPRESSION : Imf::RLE_COMPRESSION;
    return headers;
}

void copy_lines(LineSource& source, int lines, Imf::OStream& stream) {
    const std::vector<Imf::Header> headers = headers_of_copy(source.picture(), lines);
    const int part = source.picture().part();
    Imf::MultiPartOutputFile file(stream, headers.data(), static_cast<int>(headers.size()),
                                  /*overrideSharedAttributes=*/false, /*numThreads=*/0);
    Imf::TiledOutputPart out(file, part);
    LineBuffer buffer(source.picture(), lines);
    for (int row = 0; row < out.numYTiles(); ++row) {
        const Box2i tile = out.dataWindowForTile(0, row);
        const Imf::FrameBuffer frame = buffer.at(tile.min.y);
        if (!source.read(frame, tile.min.y, tile.max.y)) continue;
        out.setFrameBuffer(frame);
        out.writeTiles(0, out.numXTiles() - 1, row, row);
    }
}

}  // namespace

bool has_lines(const ExrPicture& picture) {
    if (picture.block().tile) return false;
    const Imf::ChannelList& channels = picture.header().channels();
    for (auto it = channels.begin(); it != channels.end(); ++it)
        if (it.channel().xSampling != 1 || it.channel().ySampling != 1) return false;
    return true;
}

bool is_spooled(const ExrPicture& picture) {
    constexpr std::int64_t kWide = 4096;  // four tiles of 1024
    return picture.block().width > kWide && picture.header().compression() != Imf::NO_COMPRESSION &&
           has_lines(picture);
}

std::vector<std::string> spool_exr(const std::string& path, const std::string& out_path,
                                   const ReadImageOptions& options) {
    LineSource source(path, options);
    if (!has_lines(source.picture()))
        throw Error(ErrorKind::kUnsupported, cat(path, ": this EXR is not one of whole lines"));
    std::vector<std::string> warnings = source.picture().zero_pixel().warnings;
    AtomicFile file(out_path, /*overwrite=*/true);
    FileOutput stream(file);
    translate_errors(ErrorKind::kIo, cat(out_path, ": cannot write"),
                     [&] { copy_lines(source, tile_lines(source.picture()), stream); });
    stream.check();
    file.commit();
    if (!source.broken().empty()) warnings.push_back(cat("not all of it can be read: ", source.broken()));
    return warnings;
}

}  // namespace imgmesh
