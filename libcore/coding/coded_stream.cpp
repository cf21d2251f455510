#include "libcore/coding/coded_stream.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "libcore/base/error.h"
#include "libcore/coding/code_faces.h"
#include "libcore/coding/code_points.h"
#include "libcore/coding/color_model.h"
#include "libcore/coding/color_transform.h"
#include "libcore/coding/numbers.h"
#include "libcore/coding/range_coder.h"

namespace imgmesh::coding {
namespace {

constexpr std::array<std::uint8_t, 3> kSignature = {0x9A, 'I', 'M'};
constexpr int kVersion = 1;

// Of the number codes, where files are small.
constexpr int kStepOrder = 2, kInnerOrder = 7, kBorderOrder = 4, kStepIndexBits = 8, kStepShiftBits = 5;
constexpr int kLeastShift = -8;

bool raster_less(const GridPoint& a, const GridPoint& b) {
    return a[1] != b[1] ? a[1] < b[1] : a[0] < b[0];
}

// The points of the border without its corners, as one line: top, right, bottom, left.
struct BorderLine {
    int across, down;  // points of a side without its corners

    explicit BorderLine(const CodedGrid& grid) : across(grid.columns() - 2), down(grid.rows() - 2) {}
    int size() const { return 2 * (across + down); }
    GridPoint point(int at) const {
        if (at < across) return {at + 1, 0};
        if ((at -= across) < down) return {across + 1, at + 1};
        if ((at -= down) < across) return {at + 1, down + 1};
        return {0, at - across + 1};
    }
    // Returns -1 for corners and points inside.
    int place(const GridPoint& p) const {
        const bool left = p[0] == 0, right = p[0] == across + 1, top = p[1] == 0, bottom = p[1] == down + 1;
        if ((left || right) == (top || bottom)) return -1;
        if (top) return p[0] - 1;
        if (right) return across + p[1] - 1;
        if (bottom) return across + down + p[0] - 1;
        return 2 * across + down + p[1] - 1;
    }
};

// Codes the points of the content, which a decoder finds in raster order. most_vertices: 0 for an encoder.
template <class Coder>
void code_all_points(Coder& coder, StreamContent& content, std::size_t most_vertices) {
    const CodedGrid& grid = content.grid;
    const BorderLine line(grid);
    std::vector<GridPoint> border, inside;
    for (const GridPoint& p : content.point) {
        const int place = line.place(p);
        const bool corner = (p[0] == 0 || p[0] == line.across + 1) && (p[1] == 0 || p[1] == line.down + 1);
        if (place >= 0)
            border.push_back({place, 0});
        else if (!corner)
            inside.push_back({p[0] - 1, p[1] - 1});
    }
    const std::uint32_t inner = code_number(coder, static_cast<std::uint32_t>(inside.size()), kInnerOrder);
    const std::uint32_t outer = code_number(coder, static_cast<std::uint32_t>(border.size()), kBorderOrder);
    const std::int64_t room = std::int64_t{line.across} * line.down;
    if (Coder::kDecodes && (inner > room || outer > static_cast<std::uint32_t>(line.size()) ||
                            std::size_t{inner} + outer > most_vertices))
        throw Error(ErrorKind::kBadFile,
                    cat("says to hold ", std::size_t{inner} + outer,
                        " vertices, more than its grid, its bytes or memory have room for"));
    HalvesModel border_model, inner_model;
    border = code_points(coder, border_model, line.size(), 1, outer, border);
    inside = code_points(coder, inner_model, line.across, line.down, inner, inside);
    if constexpr (Coder::kDecodes) {
        content.point = {{0, 0}, {line.across + 1, 0}, {0, line.down + 1}, {line.across + 1, line.down + 1}};
        for (const auto& [place, zero] : border) content.point.push_back(line.point(place));
        for (const auto& [x, y] : inside) content.point.push_back({x + 1, y + 1});
        std::sort(content.point.begin(), content.point.end(), raster_less);
    }
}

// The order of a curve that fills the plane (Morton 1966): near points come near each other.
std::vector<Id> curve_order(const std::vector<GridPoint>& points) {
    const auto spread = [](std::int32_t n) {
        auto x = static_cast<std::uint64_t>(n);
        x = (x | x << 16) & 0x0000FFFF0000FFFF;
        x = (x | x << 8) & 0x00FF00FF00FF00FF;
        x = (x | x << 4) & 0x0F0F0F0F0F0F0F0F;
        x = (x | x << 2) & 0x3333333333333333;
        return (x | x << 1) & 0x5555555555555555;
    };
    std::vector<std::pair<std::uint64_t, Id>> keys;
    keys.reserve(points.size());
    for (Id v = 0; v < points.size(); ++v)
        keys.emplace_back(spread(points[v][1]) << 1 | spread(points[v][0]), v);
    std::sort(keys.begin(), keys.end());
    std::vector<Id> order;
    order.reserve(points.size());
    for (const auto& [key, v] : keys) order.push_back(v);
    return order;
}

// The vertex that completes a face on the left of an edge.
class WantedFaces {
  public:
    WantedFaces(std::size_t vertices, const std::vector<Face>& faces)
        : first_(vertices + 1, 0), ends_(3 * faces.size()) {
        for (const Face& face : faces)
            for (const Id v : face) ++first_[v + 1];
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        std::vector<std::uint32_t> at(first_.begin(), first_.end() - 1);
        for (const auto& [a, b, c] : faces) {
            ends_[at[a]++] = {b, c};
            ends_[at[b]++] = {c, a};
            ends_[at[c]++] = {a, b};
        }
    }
    Id operator()(Id a, Id b) const {
        for (std::uint32_t i = first_[a]; i < first_[a + 1]; ++i)
            if (ends_[i].first == b) return ends_[i].second;
        return kNone;
    }

  private:
    std::vector<std::uint32_t> first_;
    std::vector<std::pair<Id, Id>> ends_;
};

template <class Coder>
void code_all_faces(Coder& coder, StreamContent& content) {
    std::vector<Place> places;
    places.reserve(content.point.size());
    for (const auto& [column, row] : content.point)
        places.push_back({content.grid.x(column), content.grid.y(row)});
    Triangulation faces(places, curve_order(content.point));
    FaceCoder(faces).code(coder, WantedFaces(content.point.size(), content.faces));
    content.faces.clear();
    for (Id f = 0; f < faces.face_count(); ++f) content.faces.push_back(faces.face(f).corner);
}

template <class Coder>
void code_steps(Coder& coder, StreamContent& content) {
    auto& index = content.step_index;
    index[0] = static_cast<int>(code_bits(coder, static_cast<std::uint32_t>(index[0]), kStepIndexBits));
    for (std::size_t k = 1; k < static_cast<std::size_t>(content.channels); ++k)
        index[k] = index[0] + kLeastShift +
                   static_cast<int>(code_bits(
                       coder, static_cast<std::uint32_t>(index[k] - index[0] - kLeastShift), kStepShiftBits));
    for (std::size_t k = 0; k < static_cast<std::size_t>(content.channels); ++k)
        if (index[k] < 0 || index[k] >= kStepIndices)
            throw Error(ErrorKind::kBadFile,
                        cat("has a colour step of index ", index[k], ", not 0 to ", kStepIndices - 1));
}

template <class Coder>
void code_all_colors(Coder& coder, StreamContent& content) {
    const auto channels = static_cast<std::size_t>(content.channels);
    std::array<std::int32_t, 4> steps{};
    for (std::size_t k = 0; k < channels; ++k) steps[k] = color_step(content.step_index[k]);
    const ColorPlan plan = plan_colors(content.shape());
    ColorModel model(plan, content.channels, steps);
    content.level.resize(content.point.size() * channels);
    for (std::size_t v = 0; v < content.point.size(); ++v)
        for (std::size_t k = 0; k < channels; ++k) {
            int& level = content.level[v * channels + k];
            level = model.code(coder, v, model.guess(v, k), level);
        }
    content.color.assign(model.values().begin(), model.values().end());
    for (std::size_t v = 0; v < content.point.size(); ++v)
        from_coded(std::span(content.color).subspan(v * channels, channels));
}

void put_varint(std::vector<std::uint8_t>& out, std::uint32_t number) {
    for (; number >= 0x80; number >>= 7) out.push_back(static_cast<std::uint8_t>(number | 0x80));
    out.push_back(static_cast<std::uint8_t>(number));
}

[[noreturn]] void ends_early() {
    throw Error(ErrorKind::kBadFile, "ends too early");
}

std::uint32_t take_varint(std::span<const std::uint8_t>& bytes) {
    std::uint32_t number = 0;
    for (int shift = 0; shift < 21; shift += 7) {
        if (bytes.empty()) ends_early();
        const std::uint8_t byte = bytes[0];
        bytes = bytes.subspan(1);
        number |= static_cast<std::uint32_t>(byte & 0x7F) << shift;
        if (byte < 0x80) return number;
    }
    throw Error(ErrorKind::kBadFile, "has a size of more than three bytes");
}

// What comes before the vertices, and the coder after it.
struct Opening {
    StreamContent content;
    RangeDecoder coder;
};

Opening open_stream(std::span<const std::uint8_t> bytes) {
    if (bytes.size() < kSignature.size() + 1 ||
        !std::equal(kSignature.begin(), kSignature.end(), bytes.begin()))
        throw Error(ErrorKind::kBadFile, "is no coded picture: it does not begin with its signature");
    const std::uint8_t kind = bytes[kSignature.size()];
    if (kind >> 4 != kVersion)
        throw Error(ErrorKind::kUnsupported, cat("has version ", kind >> 4, ", not ", kVersion));
    if ((kind & 0x0C) != 0) throw Error(ErrorKind::kBadFile, "has bits set that version 1 does not know");
    StreamContent content;
    content.channels = (kind & 3) + 1;
    bytes = bytes.subspan(kSignature.size() + 1);
    const std::uint32_t width = take_varint(bytes) + 1, height = take_varint(bytes) + 1;
    if (width > kMaxSide || height > kMaxSide || std::int64_t{width} * height > kMaxPixels)
        throw Error(ErrorKind::kBadFile, cat("is ", width, " x ", height, " pixels, more than ", kMaxSide,
                                             " a side or ", kMaxPixels, " in all"));
    RangeDecoder coder(bytes);
    const std::uint32_t step = code_number(coder, 0, kStepOrder);
    content.grid = {static_cast<int>(width), static_cast<int>(height),
                    static_cast<int>(std::min(step, 4u * kMaxSide)) + 1};
    if (std::int64_t{content.grid.columns()} * content.grid.rows() > kMaxPixels)
        throw Error(ErrorKind::kBadFile, cat("has a grid of ", content.grid.columns(), " x ",
                                             content.grid.rows(), " points, more than ", kMaxPixels));
    code_steps(coder, content);
    return {std::move(content), coder};
}

}  // namespace

StreamContent arranged(const CodedMesh& mesh) {
    StreamContent content;
    content.grid = mesh.grid;
    content.channels = mesh.channels;
    std::vector<Id> order(mesh.point.size()), number(mesh.point.size());
    std::iota(order.begin(), order.end(), Id{0});
    std::sort(order.begin(), order.end(),
              [&](Id a, Id b) { return raster_less(mesh.point[a], mesh.point[b]); });
    for (Id k = 0; k < order.size(); ++k) {
        number[order[k]] = k;
        content.point.push_back(mesh.point[order[k]]);
    }
    for (const auto& [a, b, c] : mesh.faces) content.faces.push_back({number[a], number[b], number[c]});
    NoCoder none;
    code_all_faces(none, content);
    return content;
}

std::vector<std::uint8_t> write_stream(StreamContent& content, StreamSizes* sizes) {
    std::vector<std::uint8_t> out(kSignature.begin(), kSignature.end());
    out.push_back(static_cast<std::uint8_t>(kVersion << 4 | (content.channels - 1)));
    put_varint(out, static_cast<std::uint32_t>(content.grid.width - 1));
    put_varint(out, static_cast<std::uint32_t>(content.grid.height - 1));
    RangeEncoder coder;
    code_number(coder, static_cast<std::uint32_t>(content.grid.step - 1), kStepOrder);
    code_steps(coder, content);
    const std::size_t steps_end = coder.size();
    code_all_points(coder, content, 0);
    const std::size_t points_end = coder.size();
    code_all_faces(coder, content);
    const std::size_t faces_end = coder.size();
    code_all_colors(coder, content);
    const std::vector<std::uint8_t> coded = coder.finish();
    if (sizes)
        *sizes = {out.size() + steps_end, points_end - steps_end, faces_end - points_end,
                  coded.size() - faces_end};
    out.insert(out.end(), coded.begin(), coded.end());
    return out;
}

StreamHead read_head(std::span<const std::uint8_t> bytes) {
    const StreamContent content = open_stream(bytes).content;
    return {content.grid, content.channels};
}

StreamContent read_stream(std::span<const std::uint8_t> bytes, std::size_t limit) {
    Opening opening = open_stream(bytes);
    StreamContent& content = opening.content;
    RangeDecoder& coder = opening.coder;
    const auto check_end = [&] {
        if (coder.missing() > 4) ends_early();
    };
    code_all_points(coder, content, std::min(most_vertices(bytes.size()), limit));
    check_end();
    code_all_faces(coder, content);
    check_end();
    code_all_colors(coder, content);
    check_end();
    if (coder.left() > 0) throw Error(ErrorKind::kBadFile, cat("has bytes after its end: ", coder.left()));
    return std::move(content);
}

}  // namespace imgmesh::coding
