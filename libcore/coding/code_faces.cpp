#include "libcore/coding/code_faces.h"

#include <algorithm>
#include <bit>

namespace imgmesh::coding {
namespace {

constexpr int kMaxCotangent = 1 << 20;

// Of the angle at c, in 1/256.
int cotangent(const Place& a, const Place& b, const Place& c) {
    const std::int64_t dot = std::int64_t{a.x - c.x} * (b.x - c.x) + std::int64_t{a.y - c.y} * (b.y - c.y);
    const std::int64_t area = area2(a, b, c), scaled = dot * 256;
    if (area <= 0) return kMaxCotangent;  // behind the edge
    return static_cast<int>(std::clamp<std::int64_t>(scaled / area, -kMaxCotangent, kMaxCotangent));
}

// Classes of a cotangent: half octaves of its magnitude, 0 to 2 * kHalf.
constexpr int kHalf = 6;
std::uint32_t class_of(int cot) {
    const int size = cot < 0 ? -cot : cot;
    const int level =
        size < 32 ? 0 : std::min(kHalf, static_cast<int>(std::bit_width(static_cast<unsigned>(size))) - 5);
    return static_cast<std::uint32_t>(kHalf + (cot < 0 ? -level : level));
}
constexpr std::uint32_t kClasses = 2 * kHalf + 1;

std::int64_t square(std::int64_t x) {
    return x * x;
}

int centred(std::uint32_t cotangent_class) {
    return static_cast<int>(cotangent_class) - kHalf;
}

constexpr std::uint32_t kMisses = 16;

// How far c is from completing a parallelogram, in classes of its square over that of the edge.
std::uint32_t parallelogram_class(const Place& a, const Place& b, const Place& o, const Place& c) {
    const std::int64_t miss = square(a.x + b.x - o.x - c.x) + square(a.y + b.y - o.y - c.y);
    const std::int64_t edge = square(a.x - b.x) + square(a.y - b.y);
    const std::int64_t ratio = miss * 64 / edge;
    return std::min<std::uint32_t>(
        kMisses - 1, static_cast<std::uint32_t>(std::bit_width(static_cast<std::uint64_t>(ratio))));
}

}  // namespace

FaceCoder::FaceCoder(Triangulation& faces)
    : faces_(faces),
      stop_({4 * 3 * 2 * kClasses, 4 * 3 * (kClasses + 1), kClasses * (kClasses + 1), kClasses * 4 * 2,
             kMisses * kMisses * 2}),
      side_({4 * kClasses, 9 * 9, kClasses * 2, kMisses * kMisses}) {
    Id last = 0;
    for (Id f = 0; f < faces.face_count(); ++f)
        for (std::size_t i = 0; i < 3; ++i) {
            for (const Id v : faces.face(f).corner) last = std::max(last, v);
            if (faces.face(f).across[i] == kNone)
                gates_.emplace_back(faces.face(f).corner[(i + 1) % 3], faces.face(f).corner[(i + 2) % 3]);
        }
    reached_.assign(last + 1, false);
}

// A triangle (a, b, d) is empty if d is lower than all vertices passed on the left as seen from a, and lower
// than all passed on the right as seen from b; lower is nearer to the line of the edge.
GateStep FaceCoder::reach(Id a, Id b, Id face, Id left, Id right, Id low_left, Id low_right) const {
    const auto& corner = faces_.face(face).corner;
    const Id d = corner[0] != left && corner[0] != right   ? corner[0]
                 : corner[1] != left && corner[1] != right ? corner[1]
                                                           : corner[2];
    const Place pa = faces_.place(a), pb = faces_.place(b), pd = faces_.place(d);
    // Where nothing was passed on one side, the line of the edge itself is the limit.
    const bool in_front = area2(pa, pb, pd) > 0;
    GateStep step{face, left, right, low_left, low_right, d};
    step.goes_left = low_left == kNone ? in_front : area2(pa, pd, faces_.place(low_left)) > 0;
    step.goes_right = low_right == kNone ? in_front : area2(pd, pb, faces_.place(low_right)) > 0;
    step.may_stop = in_front && step.goes_left && step.goes_right;
    step.cotangent = step.may_stop ? cotangent(pa, pb, pd) : kMaxCotangent;
    return step;
}

GateStep FaceCoder::ahead(Id a, Id b, const GateStep& from, bool left) const {
    if (!(left ? from.goes_left : from.goes_right)) return {};
    const LinkedFace& face = faces_.face(from.face);
    const Id dropped = left ? from.right : from.left;
    const Id g = face.across[face.corner[0] == dropped ? 0 : face.corner[1] == dropped ? 1 : 2];
    if (g == kNone || faces_.face(g).known) return {};
    if (left)
        return reach(a, b, g, from.left, from.apex, from.low_left,
                     from.goes_right ? from.apex : from.low_right);
    return reach(a, b, g, from.apex, from.right, from.goes_left ? from.apex : from.low_left, from.low_right);
}

Id FaceCoder::reachable(Id a, Id b, Id face, Id target) const {
    GateStep step = reach(a, b, face, a, b, kNone, kNone);
    const Id first = step.apex;
    if (target == kNone) return first;
    for (int depth = 0; depth < kMaxSteps; ++depth) {
        if (step.may_stop && step.apex == target) return target;
        const GateStep left = ahead(a, b, step, true), right = ahead(a, b, step, false);
        if (left.face == kNone && right.face == kNone) break;
        step = right.face == kNone || (left.face != kNone && goes_left(b, step.apex, target)) ? left : right;
    }
    return first;
}

void FaceCoder::close(Id a, Id b, Id apex) {
    faces_.fix_face(a, b, apex, strip_);
    gates_.emplace_back(a, apex);
    gates_.emplace_back(apex, b);
    reached_[a] = reached_[b] = reached_[apex] = true;
}

// The face on the other side of the gate, or kNone at the border.
Id FaceCoder::face_behind(Id a) const {
    const Id first = strip_[0];
    return faces_.face(first).across[faces_.opposite(first, a)];
}

// The coefficients of both decisions' odds were fitted to twelve photographs.
FaceCoder::Decision<FaceCoder::kStopInputs> FaceCoder::stop_decision(Id a, Id b, int depth,
                                                                     const GateStep& step,
                                                                     const GateStep& left,
                                                                     const GateStep& right) const {
    const LinkedFace& face = faces_.face(step.face);
    const auto is_known = [&](Id v) {
        const Id g = face.across[face.corner[0] == v ? 0 : face.corner[1] == v ? 1 : 2];
        return g == kNone || faces_.face(g).known;
    };
    // Sides of (a, b, apex) that are known already.
    const std::uint32_t known =
        (step.left == a && is_known(step.right)) + (step.right == b && is_known(step.left));
    const auto k = static_cast<std::uint32_t>(std::min(depth, 3));
    const std::uint32_t reached = reached_[step.apex];
    const std::uint32_t own = class_of(step.cotangent);
    const int next = std::min(left.face == kNone ? kMaxCotangent : left.cotangent,
                              right.face == kNone ? kMaxCotangent : right.cotangent);
    const bool is_last = next == kMaxCotangent;
    const std::uint32_t gap = is_last ? kClasses : class_of(next - step.cotangent);
    const Place pa = faces_.place(a), pb = faces_.place(b), pd = faces_.place(step.apex);
    const std::uint32_t thin = class_of(std::max(cotangent(pb, pd, pa), cotangent(pd, pa, pb)));
    std::uint32_t flat = kClasses, miss = kMisses - 1, other = kMisses - 1;
    int odds = -221 - std::array{0, 110, 93, 69}[k] + 236 * static_cast<int>(known) -
               53 * static_cast<int>(reached) - 13 * centred(own) + (is_last ? 424 : 8 * centred(gap)) +
               44 * centred(thin);
    if (const Id behind = face_behind(a); behind != kNone) {
        const Place po = faces_.place(faces_.face(behind).corner[faces_.opposite(behind, b)]);
        flat = class_of(step.cotangent + cotangent(pb, pa, po));
        miss = parallelogram_class(pa, pb, po, pd);
        odds += 24 * centred(flat);
        if (!is_last) {
            const GateStep& ahead = left.face != kNone && next == left.cotangent ? left : right;
            other = parallelogram_class(pa, pb, po, faces_.place(ahead.apex));
            odds += 16 * (static_cast<int>(other) - static_cast<int>(miss));
        }
    } else {
        odds += 156;
    }
    return {
        {((k * 3 + known) * 2 + reached) * kClasses + own, (k * 3 + known) * (kClasses + 1) + gap,
         own * (kClasses + 1) + flat, (thin * 4 + k) * 2 + reached, (miss * kMisses + other) * 2 + (k > 0)},
        odds};
}

FaceCoder::Decision<FaceCoder::kSideInputs> FaceCoder::side_decision(Id a, Id b, int depth,
                                                                     const GateStep& step,
                                                                     const GateStep& left,
                                                                     const GateStep& right) const {
    // As seen from the side whose apex has the larger angle.
    const bool turned = left.cotangent > right.cotangent;
    const GateStep &first = turned ? right : left, &second = turned ? left : right;
    const bool later = depth > 0;
    const auto kind = [&](const GateStep& s) {
        return static_cast<std::uint32_t>(!s.may_stop ? 0 : 1 + reached_[s.apex]) * 3 +
               static_cast<std::uint32_t>(s.goes_left && s.goes_right ? 2
                                          : s.goes_left               ? 1
                                                                      : 0);
    };
    const std::uint32_t gap = class_of(second.cotangent - first.cotangent);
    const Place pa = faces_.place(a), pb = faces_.place(b), pd = faces_.place(step.apex);
    const int lean = cotangent(pb, pd, pa) - cotangent(pd, pa, pb);
    std::uint32_t miss = kMisses - 1, other = kMisses - 1;
    int odds = 28 - (later ? 84 : 0) - (first.may_stop ? 0 : 394) + (second.may_stop ? 0 : 555);
    if (const Id behind = face_behind(a); behind != kNone) {
        const Place po = faces_.place(faces_.face(behind).corner[faces_.opposite(behind, b)]);
        miss = parallelogram_class(pa, pb, po, faces_.place(first.apex));
        other = parallelogram_class(pa, pb, po, faces_.place(second.apex));
        odds += 22 * (static_cast<int>(other) - static_cast<int>(miss));
    }
    return {{static_cast<std::uint32_t>(std::min(depth, 3)) * kClasses + gap, kind(first) * 9 + kind(second),
             class_of(turned ? -lean : lean) * 2 + later, miss * kMisses + other},
            odds};
}

}  // namespace imgmesh::coding
