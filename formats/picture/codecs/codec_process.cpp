#include "formats/picture/codecs/codec_process.h"

#include <sys/wait.h>

#include <csignal>
#include <cstring>

#include "formats/files/one_line.h"
#include "formats/picture/codecs/codec_program.h"
#include "formats/picture/codecs/codec_types.h"

namespace imgmesh {
namespace {

using std::chrono::seconds;

// To load it from a slow disk on a busy machine. (It takes 0.2 s.)
constexpr seconds kToStart{120};
// The job limits its own processor time (program/job_limits.h). This is for one that sleeps, on any machine.
constexpr seconds kToOffer{1200};
constexpr seconds kToFinish{4 * 3600};

// A program that ends by itself, having nothing to do, may do so in the moment of a new job, and one may be
// ended from outside: no image gets near it, jobs are processes of their own. More often it cannot be
// accident.
constexpr int kMostStarts = 3;

// Names, profiles and warnings; and what no image within any limits takes.
constexpr std::uint64_t kMostHeader = std::uint64_t{64} << 20;
constexpr std::uint64_t kMostData = std::uint64_t{1} << 44;

Error failure(const JobName& name, const ReplyMessage& reply) {
    if (reply.kind == ReplyKind::kError) {
        std::string text(reply.text, ::strnlen(reply.text, sizeof(reply.text)));
        if (reply.code < 0 || reply.code > static_cast<std::int32_t>(ErrorKind::kUnsupported))
            return wrong_answer(name);
        return {static_cast<ErrorKind>(reply.code), printable(std::move(text))};
    }
    if (reply.kind == ReplyKind::kNoMemory) return {name.kind, cat(name.who, " needs too much memory")};
    if (reply.kind != ReplyKind::kDied) return wrong_answer(name);
    const int status = reply.code;
    if (!WIFSIGNALED(status)) {
#ifdef IMGMESH_SANITIZED
        return {ErrorKind::kInternal, cat(name.who, " ended, maybe by a sanitizer")};
#else
        return {name.kind, cat(name.who, " ended early (exit code ", WEXITSTATUS(status), ")")};
#endif
    }
    const int signal = WTERMSIG(status);
    if (signal == SIGXCPU) return {name.kind, cat(name.who, " took too long")};
    return {name.kind, cat(name.who, " crashed (signal ", signal, ")")};
}

// The next reply of a job that has started.
ReplyMessage next_reply(const JobName& name, int socket, seconds patience) {
    ReplyMessage reply;
    switch (receive_message(socket, reply, nullptr, patience)) {
        case Received::kMessage:
            break;
        case Received::kEnd:
            throw Error(name.kind, cat(name.who, " was ended"));
        case Received::kTimeout:
            throw Error(name.kind, cat(name.who, " took too long"));
    }
    if (reply.magic != kCodecMagic) throw wrong_answer(name);
    if (reply.kind != ReplyKind::kOffer && reply.kind != ReplyKind::kDone) throw failure(name, reply);
    return reply;
}

}  // namespace

Error wrong_answer(const JobName& name) {
    return {name.kind, cat(name.who, " gave a wrong answer")};
}

std::shared_ptr<CodecServer> CodecProcess::server() {
    const std::lock_guard lock(mutex_);
    if (server_ && !server_->is_ours()) server_.reset();
    if (!server_) {
        const std::string program = find_();
        if (program.empty())
            throw Error(ErrorKind::kUnsupported, "imgmesh's program imgmesh-codecs is not installed");
        server_ = std::make_shared<CodecServer>(program);
    }
    return server_;
}

void CodecProcess::forget(const std::shared_ptr<CodecServer>& server) {
    const std::lock_guard lock(mutex_);
    if (server_ == server) server_.reset();
}

JobResult CodecProcess::run(const JobName& name, CodecJob job, const SharedMemory& input,
                            std::uint64_t header_bytes,
                            const std::function<void(const ReplyMessage&)>& accept) {
    FileDescriptor socket;
    for (int start = 1;; ++start) {
        const std::shared_ptr<CodecServer> running = server();
        auto [ours, theirs] = socket_pair();
        const JobMessage message{
            .job = job, .header_bytes = header_bytes, .input_bytes = input.bytes().size()};
        const bool sent = send_message(running->socket(), message, {theirs.get(), input.file()});
        theirs.close();
        ReplyMessage reply;
        const Received received =
            sent ? receive_message(ours.get(), reply, nullptr, kToStart) : Received::kEnd;
        if (received == Received::kMessage) {
            if (reply.magic != kCodecMagic) throw wrong_answer(name);
            if (reply.kind != ReplyKind::kStarted) throw failure(name, reply);
            socket = std::move(ours);
            break;
        }
        forget(running);
        const CodecServer::End end = received == Received::kTimeout
                                         ? CodecServer::End{.reason = "it does not answer"}
                                         : running->end();
        if ((!end.reason.empty() && !end.by_signal) || start == kMostStarts)
            throw Error(ErrorKind::kUnsupported,
                        cat("cannot start imgmesh-codecs: ", end.reason.empty() ? "it ends" : end.reason));
    }

    JobResult result;
    ReplyMessage reply = next_reply(name, socket.get(), kToOffer);
    if (reply.kind == ReplyKind::kOffer) {
        if (reply.header_bytes > kMostHeader || reply.data_bytes > kMostData) throw wrong_answer(name);
        accept(reply);
        result.memory = SharedMemory(data_offset(reply.header_bytes) + reply.data_bytes);
        result.offer = reply;
        const std::uint8_t any = 0;
        send_message(socket.get(), any,
                     {result.memory.file()});  // if nobody is there, the next line finds out
        reply = next_reply(name, socket.get(), kToFinish);
    }
    if (reply.kind != ReplyKind::kDone) throw wrong_answer(name);
    return result;
}

CodecProcess& codec_process() {
    static CodecProcess process(&find_codec_program);
    return process;
}

}  // namespace imgmesh
