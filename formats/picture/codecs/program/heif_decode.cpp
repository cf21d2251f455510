// HEIC and AVIF through libheif. OpenImageIO reads them with 8 bits and without their colours.
#include <libheif/heif.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "formats/files/one_line.h"
#include "formats/picture/codecs/program/codecs.h"
#include "formats/picture/codecs/program/hevc_color.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

template <typename T, void (*close)(T*)>
struct Closer {
    void operator()(T* object) const { close(object); }
};
void release_handle(const heif_image_handle* handle) {
    heif_image_handle_release(handle);
}
void release_image(const heif_image* image) {
    heif_image_release(image);
}
using Context = std::unique_ptr<heif_context, Closer<heif_context, heif_context_free>>;
using Handle = std::unique_ptr<const heif_image_handle, Closer<const heif_image_handle, release_handle>>;
using Decoded = std::unique_ptr<const heif_image, Closer<const heif_image, release_image>>;
using Nclx =
    std::unique_ptr<heif_color_profile_nclx, Closer<heif_color_profile_nclx, heif_nclx_color_profile_free>>;

// A profile counts before code points (ISO/IEC 23000-22, 7.3.6.4).
StatedColor color_of(const heif_image_handle* handle, const heif_image* image,
                     std::span<const std::uint8_t> file) {
    StatedColor color;
    const std::size_t size = heif_image_handle_get_raw_color_profile_size(handle);
    color.icc.resize(size);
    if (size > 0 && heif_image_handle_get_raw_color_profile(handle, color.icc.data()).code != heif_error_Ok)
        color.icc.clear();
    if (!color.icc.empty()) return color;
    heif_color_profile_nclx* found = nullptr;
    if (heif_image_handle_get_nclx_color_profile(handle, &found).code != heif_error_Ok)
        heif_image_get_nclx_color_profile(image, &found);  // of the stream of pixels itself
    if (const Nclx nclx{found})
        color.code_points = CodePoints{nclx->color_primaries, nclx->transfer_characteristics};
    else
        color.code_points = hevc_code_points(file);  // which libheif does not look for
    return color;
}

// Samples of more than 8 bits become 16.
void copy_words(const std::uint8_t* row, std::size_t samples, int bits, std::uint8_t* out) {
    const std::uint32_t most = (1u << bits) - 1;
    for (std::size_t i = 0; i < samples; ++i) {
        std::uint16_t code = 0;
        std::memcpy(&code, row + 2 * i, 2);
        code = static_cast<std::uint16_t>((std::min<std::uint32_t>(code, most) * 65535u + most / 2) / most);
        std::memcpy(out + 2 * i, &code, 2);
    }
}

// Returns what the decoder says last, or nothing. libheif 1.15 writes all warnings from the first wanted one
// on, whatever room there is for them, and their texts are in one place, which keeps the last.
std::string last_warning(heif_image* decoded) {
    const int count = heif_image_get_decoding_warnings(decoded, 0, nullptr, 0);
    if (count < 1) return {};
    heif_error warning = {};
    heif_image_get_decoding_warnings(decoded, count - 1, &warning, 1);
    return warning.message ? one_line(warning.message) : std::string();
}

}  // namespace

void decode_by_libheif(const DecodeTask& task, std::span<const std::uint8_t> bytes,
                       const OfferPicture& offer) {
    const auto check = [&](const heif_error& error) {
        if (error.code == heif_error_Ok) return;
        const bool unsupported =
            error.code == heif_error_Unsupported_feature || error.code == heif_error_Unsupported_filetype;
        throw Error(
            unsupported ? ErrorKind::kUnsupported : ErrorKind::kBadFile,
            cat(task.path, ": cannot read the image: ", one_line(error.message ? error.message : "")));
    };
    const Context context(heif_context_alloc());
    if (!context) throw std::bad_alloc();
    heif_context_set_max_decoding_threads(context.get(), 0);  // none beside this one
    check(heif_context_read_from_memory_without_copy(context.get(), bytes.data(), bytes.size(), nullptr));
    heif_image_handle* primary = nullptr;
    check(heif_context_get_primary_image_handle(context.get(), &primary));
    const Handle handle(primary);
    // A grid has a size of its own beside the one that the file claims and imgmesh has checked; only a lie is
    // larger. The library refuses sides that reach the limit.
    const std::int64_t longest = std::max({task.claim.width, task.claim.height,
                                           std::int64_t{heif_image_handle_get_ispe_width(primary)},
                                           std::int64_t{heif_image_handle_get_ispe_height(primary)}});
    heif_context_set_maximum_image_size_limit(context.get(), static_cast<int>(longest + 1));

    const bool alpha = heif_image_handle_has_alpha_channel(primary);
    const int bits = heif_image_handle_get_luma_bits_per_pixel(primary);
    const heif_chroma layout =
        bits > 8 ? (alpha ? heif_chroma_interleaved_RRGGBBAA_LE : heif_chroma_interleaved_RRGGBB_LE)
                 : (alpha ? heif_chroma_interleaved_RGBA : heif_chroma_interleaved_RGB);
    heif_image* decoded = nullptr;
    check(heif_decode_image(primary, &decoded, heif_colorspace_RGB, layout, nullptr));
    const Decoded image(decoded);

    CodecPicture out;
    out.width = heif_image_get_width(decoded, heif_channel_interleaved);
    out.height = heif_image_get_height(decoded, heif_channel_interleaved);
    out.channel_names = {"R", "G", "B"};
    if (alpha) out.channel_names.emplace_back("A");
    out.channels = static_cast<std::int64_t>(out.channel_names.size());
    out.sample_type = bits > 8 ? SampleType::kUint16 : SampleType::kUint8;
    out.associated_alpha = alpha && heif_image_handle_is_premultiplied_alpha(primary);
    out.color = color_of(primary, decoded, bytes);  // turned and mirrored already
    if (const std::string warning = last_warning(decoded); !warning.empty())
        out.warnings.push_back(cat("its decoder says: ", warning));

    int stride = 0;
    const std::uint8_t* const rows =
        heif_image_get_plane_readonly(decoded, heif_channel_interleaved, &stride);
    if (!rows || out.width < 1 || out.height < 1)
        throw Error(ErrorKind::kBadFile, cat(task.path, ": cannot read the image: its decoder gave none"));
    const std::span<std::uint8_t> samples = offer(out);
    const auto row_samples = static_cast<std::size_t>(out.width * out.channels);
    const std::size_t row_bytes = row_samples * bytes_of_sample(out.sample_type);
    const int depth = heif_image_get_bits_per_pixel_range(decoded, heif_channel_interleaved);
    for (std::size_t y = 0; y < static_cast<std::size_t>(out.height); ++y) {
        const std::uint8_t* const row = rows + y * static_cast<std::size_t>(stride);
        std::uint8_t* const to = samples.data() + y * row_bytes;
        if (bits > 8)
            copy_words(row, row_samples, depth, to);
        else
            std::memcpy(to, row, row_bytes);
    }
}

}  // namespace imgmesh
