#include "formats/picture/codecs/program/job.h"

#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <new>

#include "formats/picture/codecs/program/codecs.h"
#include "formats/picture/codecs/program/job_limits.h"
#include "formats/picture/codecs/shared_memory.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

constexpr std::chrono::seconds kForMemory{600};

// Sends an offer and returns the memory that imgmesh sends back. If it sends none, it has thrown an error of
// its own and wants no more of the job.
SharedMemory memory_for(int socket, const ReplyMessage& offer) {
    std::uint8_t any = 0;
    std::vector<FileDescriptor> files(1);
    if (!send_message(socket, offer) ||
        receive_message(socket, any, &files, kForMemory) != Received::kMessage)
        ::_exit(0);
    return {std::move(files.front()), data_offset(offer.header_bytes) + offer.data_bytes};
}

std::uint64_t samples_of(std::int64_t width, std::int64_t height, std::int64_t channels) {
    constexpr std::int64_t kMost = std::int64_t{1} << 20;  // no product below overflows
    std::uint64_t product = 1;
    for (const std::int64_t side : {width, height, channels})
        product *= static_cast<std::uint64_t>(std::clamp<std::int64_t>(side, 0, kMost));
    return product;
}

class Job {
  public:
    Job(int socket, std::span<const std::uint8_t> header, std::span<std::uint8_t> data)
        : socket_(socket), header_(header), data_(data) {}

    void decode() {
        const DecodeTask task = decode_task_from(header_);
        constexpr std::int64_t kUsual = 4;  // channels, where the first bytes do not tell
        const PictureClaim& claim = task.claim;
        const auto most = static_cast<std::uint64_t>(std::max<std::int64_t>(task.limits.max_pixels, 0));
        limit_job(claim.width > 0 ? samples_of(claim.width, claim.height, std::max(claim.channels, kUsual))
                                  : std::min(most, std::uint64_t{1} << 40) * kUsual,
                  data_.size());
        const auto offer = [&](const CodecPicture& picture) { return room_for(picture); };
        if (claim.format == PictureFormat::kHeif)
            decode_by_libheif(task, data_, offer);
        else
            decode_by_oiio(task, data_, offer);
    }

    void encode() {
        const EncodeTask task = encode_task_from(header_);
        limit_job(samples_of(task.width, task.height, static_cast<std::int64_t>(task.channel_names.size())),
                  data_.size());
        const std::vector<std::uint8_t> bytes = encode_by_oiio(task, data_);
        ReplyMessage reply{.kind = ReplyKind::kOffer};
        reply.data_bytes = bytes.size();
        const SharedMemory memory = memory_for(socket_, reply);
        std::copy(bytes.begin(), bytes.end(), memory.bytes().begin());
    }

    void draw() {
        const TextTask task = text_task_from(header_);
        limit_job(samples_of(task.width, task.height, task.channels), data_.size());
        draw_by_oiio(task, data_);
    }

  private:
    std::span<std::uint8_t> room_for(const CodecPicture& picture) {
        const std::vector<std::uint8_t> header = wire_from(picture);
        ReplyMessage reply{.kind = ReplyKind::kOffer};
        reply.sample_type = static_cast<std::uint32_t>(picture.sample_type);
        reply.width = picture.width;
        reply.height = picture.height;
        reply.channels = picture.channels;
        reply.header_bytes = header.size();
        const std::uint64_t samples = samples_of(picture.width, picture.height, picture.channels);
        reply.data_bytes = samples * bytes_of_sample(picture.sample_type);
        output_ = memory_for(socket_, reply);
        limit_job(samples, data_.size());
        std::copy(header.begin(), header.end(), output_.bytes().begin());
        return output_.bytes().subspan(static_cast<std::size_t>(data_offset(header.size())),
                                       static_cast<std::size_t>(reply.data_bytes));
    }

    int socket_;
    std::span<const std::uint8_t> header_;
    std::span<std::uint8_t> data_;
    SharedMemory output_;
};

void run(const JobMessage& message, int socket, const SharedMemory& input) {
    const std::span<std::uint8_t> bytes = input.bytes();
    if (message.header_bytes > bytes.size() || data_offset(message.header_bytes) > bytes.size())
        throw Error(ErrorKind::kInternal, "a job with a wrong header");
    Job job(socket, bytes.first(static_cast<std::size_t>(message.header_bytes)),
            bytes.subspan(static_cast<std::size_t>(data_offset(message.header_bytes))));
    switch (message.job) {
        case CodecJob::kDecode:
            return job.decode();
        case CodecJob::kEncode:
            return job.encode();
        case CodecJob::kText:
            return job.draw();
    }
    throw Error(ErrorKind::kInternal, "a job of an unknown kind");
}

}  // namespace

ReplyMessage error_reply(int kind, const char* text) {
    ReplyMessage reply{.kind = ReplyKind::kError};
    reply.code = kind;
    std::strncpy(reply.text, text, sizeof(reply.text) - 1);
    return reply;
}

void do_job(const JobMessage& job, FileDescriptor socket, FileDescriptor input) {
    ReplyMessage reply{.kind = ReplyKind::kStarted};
    send_message(socket.get(), reply);
    const auto failed = [](ErrorKind kind, const char* text) {
        return error_reply(static_cast<int>(kind), text);
    };
    try {
        run(job, socket.get(), SharedMemory(std::move(input), job.input_bytes));
        reply.kind = ReplyKind::kDone;
    } catch (const Error& e) {
        reply = failed(e.kind(), e.what());
    } catch (const std::bad_alloc&) {
        reply.kind = ReplyKind::kNoMemory;
    } catch (const std::exception& e) {
        reply = failed(ErrorKind::kInternal, e.what());
    }
    send_message(socket.get(), reply);
    ::_exit(0);
}

}  // namespace imgmesh
