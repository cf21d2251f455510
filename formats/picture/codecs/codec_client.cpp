#include "formats/picture/codecs/codec_client.h"

#include <algorithm>
#include <cstring>

#include "formats/picture/codecs/codec_process.h"
#include "formats/picture/decode/picture_decoders.h"
#include "formats/picture/sample_codes.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

// Shared memory counts as a file where the size of files is limited.
SharedMemory memory_for(const std::string& path, std::uint64_t size) {
    try {
        return SharedMemory(size);
    } catch (const Error& error) {
        throw Error(error.kind(), cat(path, ": ", error.what()));
    }
}

SharedMemory input_of(const std::string& path, const std::vector<std::uint8_t>& header,
                      std::span<const std::uint8_t> data) {
    SharedMemory input = memory_for(path, data_offset(header.size()) + data.size());
    std::copy(header.begin(), header.end(), input.bytes().begin());
    std::copy(data.begin(), data.end(),
              input.bytes().begin() + static_cast<std::ptrdiff_t>(data_offset(header.size())));
    return input;
}

template <typename T>
std::span<T> as(std::span<std::uint8_t> bytes) {
    return {reinterpret_cast<T*>(bytes.data()), bytes.size() / sizeof(T)};
}

// What the program says of the image, which it may change as long as it lives: from a copy, checked.
CodecPicture picture_of(const JobName& name, const JobResult& result) {
    const auto header = result.memory.bytes().first(static_cast<std::size_t>(result.offer.header_bytes));
    const std::vector<std::uint8_t> copy(header.begin(), header.end());
    try {
        CodecPicture picture = codec_picture_from(copy);
        const bool has_inks = !picture.color.inks || result.offer.channels >= 4;
        if (has_inks && picture.channel_names.size() == static_cast<std::size_t>(result.offer.channels))
            return picture;
    } catch (const std::runtime_error&) {
    }
    throw wrong_answer(name);
}

std::vector<float> samples_of(const JobResult& result) {
    const auto offset = static_cast<std::size_t>(data_offset(result.offer.header_bytes));
    const std::span<std::uint8_t> data = result.memory.bytes().subspan(offset);
    switch (static_cast<SampleType>(result.offer.sample_type)) {
        case SampleType::kUint8: {
            std::vector<float> out(data.size());
            floats_from_codes(data, out);
            return out;
        }
        case SampleType::kUint16: {
            const auto codes = as<std::uint16_t>(data);
            std::vector<float> out(codes.size());
            floats_from_codes(codes, out);
            return out;
        }
        case SampleType::kHalf:
        case SampleType::kFloat:
            break;
    }
    const auto floats = as<float>(data);
    return {floats.begin(), floats.end()};
}

}  // namespace

DecodedPicture decode_with_codecs(const PictureFile& file) {
    const PictureClaim& claim = file.claim;
    const ImageLimits& limits = file.options.limits;
    if (claim.width != 0 || claim.height != 0)
        check_size(file.path, claim.width, claim.height, std::max<std::int64_t>(claim.channels, 1), limits);
    const JobName name{cat(file.path, ": cannot read the image: its decoder"), ErrorKind::kBadFile};
    const std::vector<std::uint8_t> header = wire_from(DecodeTask{file.path, claim, limits});
    const auto accept = [&](const ReplyMessage& offer) {
        check_size(file.path, offer.width, offer.height, offer.channels, limits);
        const auto samples = static_cast<std::uint64_t>(offer.width) *
                             static_cast<std::uint64_t>(offer.height) *
                             static_cast<std::uint64_t>(offer.channels);
        if (offer.sample_type > static_cast<std::uint32_t>(SampleType::kFloat) ||
            offer.data_bytes != samples * bytes_of_sample(static_cast<SampleType>(offer.sample_type)))
            throw wrong_answer(name);
    };
    const JobResult result = codec_process().run(
        name, CodecJob::kDecode, input_of(file.path, header, file.bytes), header.size(), accept);
    if (result.offer.kind != ReplyKind::kOffer) throw Error(name.kind, cat(name.who, " gave no image"));

    CodecPicture picture = picture_of(name, result);
    DecodedPicture out;
    out.image.width = static_cast<int>(result.offer.width);
    out.image.height = static_cast<int>(result.offer.height);
    out.image.channels = static_cast<int>(result.offer.channels);
    out.image.channel_names = std::move(picture.channel_names);
    out.image.sample_type = static_cast<SampleType>(result.offer.sample_type);
    out.image.data = samples_of(result);
    out.associated_alpha = picture.associated_alpha;
    out.orientation = picture.orientation;
    out.color = std::move(picture.color);
    out.warnings = std::move(picture.warnings);
    return out;
}

std::vector<std::uint8_t> encode_with_codecs(const EncodeTask& task, std::span<const std::uint8_t> samples) {
    const JobName name{cat(task.path, ": cannot be written: its encoder"), ErrorKind::kInternal};
    const std::vector<std::uint8_t> header = wire_from(task);
    // No format takes twice the bytes of the samples and room for a header and profile.
    const std::uint64_t most = 2 * samples.size() + task.icc.size() + (std::uint64_t{1} << 20);
    const auto accept = [&](const ReplyMessage& offer) {
        if (offer.header_bytes != 0 || offer.data_bytes > most) throw wrong_answer(name);
    };
    const JobResult result = codec_process().run(name, CodecJob::kEncode,
                                                 input_of(task.path, header, samples), header.size(), accept);
    const auto bytes = result.memory.bytes().first(static_cast<std::size_t>(result.offer.data_bytes));
    return {bytes.begin(), bytes.end()};
}

void draw_text(Image& image, const std::vector<TextLabel>& labels) {
    const JobName name{"cannot draw text: the program of codecs", ErrorKind::kInternal};
    const std::vector<std::uint8_t> header =
        wire_from(TextTask{image.width, image.height, image.channels, labels});
    const std::span<const std::uint8_t> samples{reinterpret_cast<const std::uint8_t*>(image.data.data()),
                                                image.data.size() * sizeof(float)};
    const SharedMemory input = input_of("text", header, samples);
    codec_process().run(name, CodecJob::kText, input, header.size(),
                        [&](const ReplyMessage&) { throw wrong_answer(name); });
    // The labels are drawn into the input itself.
    std::memcpy(image.data.data(), input.bytes().data() + data_offset(header.size()), samples.size());
}

}  // namespace imgmesh
