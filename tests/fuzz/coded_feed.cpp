#include <random>

#include "libcore/coding/coded_mesh_image.h"
#include "libcore/coding/coded_stream.h"
#include "libcore/coding/encode_picture.h"
#include "tests/fuzz/feeds.h"
#include "tests/fuzz/small_seeds.h"

namespace imgmesh::fuzz {
namespace {

// A few bytes could promise 2^26 pixels and as many points, each time for a second or two.
constexpr std::size_t kMostPixels = 1 << 18;

// Smooth colours with a leap and some noise.
Bitmap picture(int width, int height, int channels) {
    Bitmap out{width, height, channels, {}};
    std::mt19937 random(3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int k = 0; k < channels; ++k)
                out.data.push_back(static_cast<std::uint8_t>(
                    (40 * k + 5 * x + 3 * y + (2 * x > width ? 90 : 0) + static_cast<int>(random() % 9)) %
                    256));
    return out;
}

Bytes encoded(const Bitmap& picture, std::size_t vertices) {
    EncodeParams params;
    params.vertices = vertices;
    params.effort = 1;
    return encode_picture(picture, params).bytes;
}

}  // namespace

std::vector<Bytes> coded_seeds() {
    return {encoded(picture(1, 1, 3), 4),    encoded(picture(23, 17, 1), 30), encoded(picture(23, 17, 2), 12),
            encoded(picture(40, 29, 3), 60), encoded(picture(33, 20, 4), 25), encoded(picture(5, 90, 3), 9)};
}

bool feed_coded(std::span<const std::uint8_t> bytes) {
    return accepts([&] {
        const coding::StreamHead head = coding::read_head(bytes);
        const CodedGrid& grid = head.grid;
        if (as_index(grid.width) * as_index(grid.height) > kMostPixels ||
            as_index(grid.columns()) * as_index(grid.rows()) > kMostPixels)
            throw Error(ErrorKind::kBadFile, "more than this target draws");
        coding::StreamContent content = coding::read_stream(bytes);
        for (const int scale : {1, 2})
            coding::draw_coded(content.shape(), content.color, content.channels, grid.width / scale + 1,
                               grid.height * scale);
        coding::mesh_image_from_coded(content);
        // What was read is a picture like any other.
        const coding::StreamContent before = content;
        const coding::StreamContent again = coding::read_stream(coding::write_stream(content));
        if (again.point != before.point || again.faces != before.faces || again.color != before.color)
            throw std::logic_error("another mesh after encoding");
    });
}

}  // namespace imgmesh::fuzz
