// The faces of a coded mesh, whose vertices are known.
//
// Faces are found one by one, from the border inwards. A gate is an edge with a known face, or the border, on
// its right. The face on its left is sought in the Delaunay triangulation of what is not known yet: the first
// candidate is the apex there; each next one lies across one of the other two edges of the last. So a face
// costs a bit to stop, or one to go on and one for the side.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "libcore/coding/bit_model.h"
#include "libcore/coding/triangulation.h"

namespace imgmesh::coding {

/// A face that a walk from the gate (a, b) has reached.
struct GateStep {
    Id face = kNone;                         ///< kNone: there is no way
    Id left = kNone, right = kNone;          ///< ends of the edge that it came through
    Id low_left = kNone, low_right = kNone;  ///< an apex must be lower than these, seen from a and from b
    Id apex = kNone;
    bool goes_left = false, goes_right = false;  ///< whether the walk may go on there
    bool may_stop = false;  ///< whether (a, b, apex) holds no vertex and crosses no known face
    int cotangent = 0;      ///< of the angle at the apex, in 1/256, where it may stop
};

class FaceCoder {
  public:
    /// The triangulation is a Delaunay one without known faces.
    explicit FaceCoder(Triangulation& faces);

    /// Makes every face known. wanted(a, b) returns the vertex that completes a face on the left of (a, b),
    /// or kNone; a decoder does not call it. A wanted face that cannot be reached is replaced by the first
    /// candidate, so the faces of the triangulation are what the decoder has.
    template <class Coder, class Wanted>
    void code(Coder& coder, const Wanted& wanted) {
        while (!gates_.empty()) {
            const auto [a, b] = gates_.back();
            gates_.pop_back();
            const Id face = faces_.face_at(a, b);
            if (face == kNone || faces_.face(face).known) continue;
            Id target = kNone;
            if constexpr (!Coder::kDecodes) target = reachable(a, b, face, wanted(a, b));
            const GateStep last = walk(coder, a, b, face, target);
            close(a, b, last.apex);
        }
    }

  private:
    static constexpr int kMaxSteps = 256;
    static constexpr std::size_t kStopInputs = 5, kSideInputs = 4;

    GateStep reach(Id a, Id b, Id face, Id left, Id right, Id low_left, Id low_right) const;
    GateStep ahead(Id a, Id b, const GateStep& from, bool left) const;
    Id face_behind(Id a) const;
    Id reachable(Id a, Id b, Id face, Id target) const;
    void close(Id a, Id b, Id apex);
    // A decision's contexts, and what is expected before anything has been seen, in log odds.
    template <std::size_t Inputs>
    struct Decision {
        typename BitModel<Inputs>::Contexts contexts;
        int odds;
    };
    // The two decisions, given where the walk may go on to.
    Decision<kStopInputs> stop_decision(Id a, Id b, int depth, const GateStep& step, const GateStep& left,
                                        const GateStep& right) const;
    Decision<kSideInputs> side_decision(Id a, Id b, int depth, const GateStep& step, const GateStep& left,
                                        const GateStep& right) const;

    template <class Coder>
    GateStep walk(Coder& coder, Id a, Id b, Id face, Id target) {
        GateStep step = reach(a, b, face, a, b, kNone, kNone), last = step;
        strip_.assign(1, face);
        std::size_t length = 1;
        for (int depth = 0; depth < kMaxSteps; ++depth) {
            if (step.may_stop) {
                last = step;
                length = strip_.size();
            }
            const GateStep left = ahead(a, b, step, true), right = ahead(a, b, step, false);
            const bool go_left = left.face != kNone, go_right = right.face != kNone;
            if (!go_left && !go_right) break;
            if (step.may_stop) {
                const auto stop = stop_decision(a, b, depth, step, left, right);
                if (stop_.code(coder, step.apex == target, stop.contexts, stop.odds)) break;
            }
            bool to_left = go_left;
            if (go_left && go_right) {
                const bool turned = left.cotangent > right.cotangent;
                const auto side = side_decision(a, b, depth, step, left, right);
                to_left = turned != side_.code(coder, turned != goes_left(b, step.apex, target),
                                               side.contexts, side.odds);
            }
            step = to_left ? left : right;
            strip_.push_back(step.face);
        }
        strip_.resize(length);
        return last;
    }
    // Whether a target lies on the left of what an apex hides.
    bool goes_left(Id b, Id apex, Id target) const {
        return target != kNone && area2(faces_.place(target), faces_.place(b), faces_.place(apex)) > 0;
    }

    Triangulation& faces_;
    std::vector<std::pair<Id, Id>> gates_;
    std::vector<Id> strip_;
    std::vector<bool> reached_;  // vertices of known faces
    BitModel<kStopInputs> stop_;
    BitModel<kSideInputs> side_;
};

}  // namespace imgmesh::coding
