// encode() and decode(): coded pictures.
#include <pybind11/stl.h>

#include <algorithm>
#include <tuple>

#include "libcore/base/error.h"
#include "libcore/coding/coded_stream.h"
#include "libcore/coding/encode_picture.h"
#include "libcore/coding/image_bitmap.h"
#include "python/bind.h"
#include "python/errors.h"
#include "python/image_value.h"
#include "python/words.h"
#include "python/work.h"

namespace imgmesh::python {
namespace {

py::bytes encode(const py::object& image, const std::optional<std::int64_t>& bytes,
                 const std::optional<double>& psnr, const std::optional<std::int64_t>& vertices,
                 const std::optional<double>& quality, int effort, const std::string& tune,
                 const py::object& callback, const std::optional<int>& threads) {
    EncodeParams params{bytes, psnr, vertices, quality, effort, parse_choice("tune", tune, tune_choices())};
    if (!bytes && !psnr && !vertices && !quality) params.quality = kUsualQuality;
    std::vector<std::string> warnings;
    ReadImageOptions colors;
    colors.channels.emplace();  // the colour and alpha
    const ImagePointer own = image_from(image, colors, "image", warnings);
    const Progress progress = python_progress(callback);
    const EncodedPicture coded =
        without_gil(threads, [&] { return encode_picture(bitmap_from_image(own->image), params, progress); });
    warn(warnings);
    return {reinterpret_cast<const char*>(coded.bytes.data()), coded.bytes.size()};
}

std::shared_ptr<ImageValue> decode(const py::bytes& data, const std::optional<std::pair<int, int>>& size,
                                   const std::optional<int>& threads) {
    const std::string_view text = data;
    return without_gil(threads, [&] {
        const coding::StreamContent content =
            coding::read_stream({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
        Bitmap picture{content.grid.width, content.grid.height, content.channels, {}};
        if (size) std::tie(picture.width, picture.height) = *size;
        if (picture.width < 1 || picture.height < 1 ||
            std::max(picture.width, picture.height) > coding::kMaxSide ||
            std::int64_t{picture.width} * picture.height > coding::kMaxPixels)
            throw Error(ErrorKind::kBadArgument,
                        cat("size (", picture.width, ", ", picture.height, "): expected 1 to ",
                            coding::kMaxSide, " a side and at most ", coding::kMaxPixels, " pixels"));
        picture.data = coding::draw_coded(content.shape(), content.color, content.channels, picture.width,
                                          picture.height);
        return std::make_shared<ImageValue>(ImageValue{image_from_bitmap(picture)});
    });
}

}  // namespace

void bind_coded(py::module_& module) {
    module.def(
        "encode", encode, py::arg("image"), py::kw_only(), py::arg("bytes") = py::none(),
        py::arg("psnr") = py::none(), py::arg("vertices") = py::none(), py::arg("quality") = py::none(),
        py::arg("effort") = 3, py::arg("tune") = "psnr", py::arg("progress") = py::none(),
        py::arg("threads") = py::none(),
        R"(encode(image, *, bytes=None, psnr=None, vertices=None, quality=None, effort=3, tune='psnr', progress=None, threads=None) -> bytes

Encodes an image as a mesh of a few kilobytes, as imgmesh-encode does: the bytes of an .imgm file.

image     a path, an Image or an array
bytes     at most so many; or psnr in dB, or a number of vertices, or a quality from 0 to 100 (50 without any)
effort    1 to 5, each takes up to four times as long as the one before
tune      the error to keep low: 'psnr', 'luma' or 'ssim'
progress  called with the fraction done and the name of the stage

Raises ArgumentError for a number out of range, for more than one of the four, and for too few bytes.)");
    module.def("decode", decode, py::arg("data"), py::kw_only(), py::arg("size") = py::none(),
               py::arg("threads") = py::none(), R"(decode(data, *, size=None, threads=None) -> Image

Draws a coded picture, as imgmesh-decode does.

data  the bytes of an .imgm file
size  width and height of the drawing; that of the image that was encoded if none is given

Raises BadFileError for bytes that are none, UnsupportedError for a later version.)");
}

}  // namespace imgmesh::python
