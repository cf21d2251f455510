// A priority queue of edges that is exact enough: entries are filed by the top bits of their cost.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "libcore/base/types.h"

namespace imgmesh {

/// An edge as it stood when it was filed; out of date as soon as either end's version has moved on.
struct QueuedEdge {
    Id i, j;
    std::uint16_t version_i, version_j;
};

/// Files edges by cost >= 0, in buckets 1/8 of an octave wide, and hands out the one filed first of the
/// lowest bucket. (An exact order changes the result's error by less than 0.5 %: docs/paper-map.md. First in,
/// first out, so that edges of one cost collapse evenly over the picture.)
class BucketQueue {
  public:
    static constexpr int bucket_of(float cost) {
        return static_cast<int>(std::bit_cast<std::uint32_t>(cost) >> kShift);
    }

    void push(float cost, const QueuedEdge& edge) {
        const int bucket = bucket_of(cost);
        buckets_[static_cast<std::size_t>(bucket)].edges.push_back(edge);
        lowest_ = std::min(lowest_, bucket);
        ++size_;
    }
    bool empty() const { return size_ == 0; }
    /// The bucket that pop() would take from; the queue must not be empty.
    int lowest_bucket() {
        while (buckets_[static_cast<std::size_t>(lowest_)].edges.empty()) ++lowest_;
        return lowest_;
    }
    QueuedEdge pop() {
        Bucket& bucket = buckets_[static_cast<std::size_t>(lowest_bucket())];
        const QueuedEdge edge = bucket.edges[bucket.next++];
        if (bucket.next == bucket.edges.size()) bucket = {};  // its memory goes to the buckets that fill next
        --size_;
        return edge;
    }

  private:
    struct Bucket {
        std::vector<QueuedEdge> edges;
        std::size_t next = 0;  // the first that has not been handed out
    };
    // Sign and exponent are 9 bits, so 3 bits of the mantissa remain: 2048 buckets for the finite,
    // non-negative floats.
    static constexpr int kShift = 32 - 9 - 3;
    std::array<Bucket, (1u << 31 >> kShift)> buckets_;
    int lowest_ = 0;
    std::size_t size_ = 0;
};

}  // namespace imgmesh
