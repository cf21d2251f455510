#include "libcore/coding/check_request.h"

#include <algorithm>
#include <string_view>

#include "libcore/base/range.h"
#include "libcore/coding/coded_stream.h"

namespace imgmesh::coding {
namespace {

[[noreturn]] void refuse(const std::string& text) {
    throw Error(ErrorKind::kBadArgument, text);
}

template <typename Value, typename Range>
void check(std::string_view name, const Value& value, const Range& range) {
    if (!contains(range, value)) refuse(cat(name, " ", value, ": expected ", describe(range)));
}

}  // namespace

void check_request(const Bitmap& picture, const EncodeParams& params) {
    const std::int64_t pixels = std::int64_t{picture.width} * picture.height;
    if (picture.width < 1 || picture.height < 1) refuse("a picture to encode has no pixels");
    if (std::max(picture.width, picture.height) > kMaxSide || pixels > kMaxPixels)
        refuse(cat("a picture of ", picture.width, "x", picture.height, " pixels: expected at most ",
                   kMaxSide, " a side and ", kMaxPixels, " in all"));
    if (picture.channels < 1 || picture.channels > 4 ||
        picture.data.size() != static_cast<std::size_t>(pixels) * static_cast<std::size_t>(picture.channels))
        refuse(cat("a picture of ", picture.width, "x", picture.height, " pixels and ", picture.channels,
                   " channels has ", picture.data.size(), " samples"));
    const int wishes = params.bytes.has_value() + params.psnr.has_value() + params.vertices.has_value() +
                       params.quality.has_value();
    if (wishes != 1) refuse(cat("bytes, psnr, vertices, quality: expected one of them, not ", wishes));
    if (params.bytes) check("bytes", static_cast<std::int64_t>(*params.bytes), CountRange{1});
    if (params.psnr) check("psnr", *params.psnr, NumberRange{1, kMostPsnr});
    if (params.vertices) check("vertices", static_cast<std::int64_t>(*params.vertices), CountRange{4});
    if (params.quality) check("quality", *params.quality, NumberRange{0, kMostQuality});
    check("effort", params.effort, CountRange{1, kMostEffort});
}

}  // namespace imgmesh::coding
