// Messages between imgmesh and its program of codecs, over a pair of sockets that keeps messages apart. Both
// sides are of one build; imgmesh still believes nothing that the program says.
#pragma once

#include <chrono>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "formats/picture/codecs/file_descriptor.h"

namespace imgmesh {

enum class CodecJob : std::uint32_t { kDecode, kEncode, kText };

constexpr std::uint32_t kCodecMagic = 0x48434D49;  // "IMCH"
constexpr std::uint32_t kCodecProtocol = 2;        // to be counted up with every change of the messages

/// From imgmesh, once for each job, with two files: the job's own socket and its input. The input is a
/// header of `header_bytes` (codec_types.h) and then the file's bytes or the image's samples.
struct JobMessage {
    std::uint32_t magic = kCodecMagic;
    std::uint32_t protocol = kCodecProtocol;
    CodecJob job = CodecJob::kDecode;
    std::uint32_t unused = 0;
    std::uint64_t header_bytes = 0;
    std::uint64_t input_bytes = 0;  ///< with the header
};

enum class ReplyKind : std::uint32_t {
    kStarted,  ///< first of all: the job is in a process of its own
    kOffer,    ///< how large the result will be; imgmesh answers by sending memory for it, or not at all
    kDone,
    kError,     ///< `code` is an ErrorKind
    kNoMemory,  ///< the job's limit, or the machine's
    kDied       ///< `code` is how the job's process ended, as of waitpid()
};

/// From the program, on the job's own socket.
struct ReplyMessage {
    std::uint32_t magic = kCodecMagic;
    ReplyKind kind = ReplyKind::kStarted;
    std::int32_t code = 0;
    std::uint32_t sample_type = 0;                     ///< of an image that is offered: SampleType
    std::int64_t width = 0, height = 0, channels = 0;  ///< of an image that is offered
    std::uint64_t header_bytes = 0;                    ///< of what is offered
    std::uint64_t data_bytes = 0;                      ///< of what is offered, behind the header
    char text[8192] = {};                              ///< of an error, ends with a zero
};

/// Two sockets that are connected. Throws Error(kIo).
std::pair<FileDescriptor, FileDescriptor> socket_pair();

/// Returns false if nobody is there to receive it.
bool send_bytes(int socket, std::span<const std::uint8_t> bytes, std::initializer_list<int> files = {});
template <typename T>
bool send_message(int socket, const T& message, std::initializer_list<int> files = {}) {
    static_assert(std::is_trivially_copyable_v<T>);
    return send_bytes(socket, {reinterpret_cast<const std::uint8_t*>(&message), sizeof(T)}, files);
}

enum class Received { kMessage, kEnd, kTimeout };
/// Waits for a message of exactly the size of `bytes` and of `files->size()` files; anything else counts as
/// the end. `files` may be null for none.
Received receive_bytes(int socket, std::span<std::uint8_t> bytes, std::vector<FileDescriptor>* files,
                       std::chrono::milliseconds patience);
template <typename T>
Received receive_message(int socket, T& message, std::vector<FileDescriptor>* files,
                         std::chrono::milliseconds patience) {
    static_assert(std::is_trivially_copyable_v<T>);
    return receive_bytes(socket, {reinterpret_cast<std::uint8_t*>(&message), sizeof(T)}, files, patience);
}

/// Puts values one after another.
class WireWriter {
  public:
    template <typename T>
    void number(T value) {
        static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
        const auto* p = reinterpret_cast<const std::uint8_t*>(&value);
        bytes_.insert(bytes_.end(), p, p + sizeof(T));
    }
    void bytes(std::span<const std::uint8_t> data) {
        number(std::uint64_t{data.size()});
        bytes_.insert(bytes_.end(), data.begin(), data.end());
    }
    void text(const std::string& t) { bytes({reinterpret_cast<const std::uint8_t*>(t.data()), t.size()}); }
    const std::vector<std::uint8_t>& result() const { return bytes_; }

  private:
    std::vector<std::uint8_t> bytes_;
};

/// Takes them back. Throws std::runtime_error where the bytes end too early.
class WireReader {
  public:
    explicit WireReader(std::span<const std::uint8_t> bytes) : left_(bytes) {}
    template <typename T>
    T number() {
        static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
        T value{};
        const auto from = take(sizeof(T));
        std::copy(from.begin(), from.end(), reinterpret_cast<std::uint8_t*>(&value));
        return value;
    }
    std::vector<std::uint8_t> bytes() {
        const auto from = take(number<std::uint64_t>());
        return {from.begin(), from.end()};
    }
    std::string text() {
        const auto from = take(number<std::uint64_t>());
        return {from.begin(), from.end()};
    }
    std::size_t left() const { return left_.size(); }

  private:
    std::span<const std::uint8_t> take(std::uint64_t count) {
        if (count > left_.size()) throw std::runtime_error("a message that ends too early");
        const auto piece = left_.first(static_cast<std::size_t>(count));
        left_ = left_.subspan(static_cast<std::size_t>(count));
        return piece;
    }

    std::span<const std::uint8_t> left_;
};

}  // namespace imgmesh
