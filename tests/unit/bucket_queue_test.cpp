#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <random>
#include <vector>

#include "libcore/simplify/kernel/bucket_queue.h"

using namespace imgmesh;

namespace {

using Limits = std::numeric_limits<float>;

QueuedEdge edge(std::size_t n) {
    return {static_cast<Id>(n), static_cast<Id>(n + 1), 0, 0};
}

// The queue's contract in its plainest form: a list for each bucket.
class PlainQueue {
  public:
    void push(float cost, Id edge) { buckets_[BucketQueue::bucket_of(cost)].push_back(edge); }
    int lowest_bucket() const { return buckets_.begin()->first; }
    bool empty() const { return buckets_.empty(); }
    Id pop() {
        const auto lowest = buckets_.begin();
        const Id edge = lowest->second.front();
        lowest->second.pop_front();
        if (lowest->second.empty()) buckets_.erase(lowest);
        return edge;
    }

  private:
    std::map<int, std::deque<Id>> buckets_;
};

// Takes one edge out of both queues, which must agree on all that can be seen.
void pop_both(BucketQueue& queue, PlainQueue& plain) {
    REQUIRE(!queue.empty());
    CHECK(queue.lowest_bucket() == plain.lowest_bucket());
    CHECK(queue.pop().i == plain.pop());
    CHECK(queue.empty() == plain.empty());
}

}  // namespace

// An octave is divided in eight by the first three bits of the mantissa.
TEST_CASE("bucket queue: buckets are an eighth of an octave wide") {
    for (const float octave : {0x1p-126f, 0x1p-20f, 1.0f, 0x1p100f}) {
        const int first = BucketQueue::bucket_of(octave);
        for (int eighth = 0; eighth < 8; ++eighth) {
            const float begin = octave * (1 + static_cast<float>(eighth) / 8);
            CHECK(BucketQueue::bucket_of(begin) == first + eighth);
            const float last = std::nextafter(octave * (1 + static_cast<float>(eighth + 1) / 8), 0.0f);
            CHECK(BucketQueue::bucket_of(last) == first + eighth);
        }
    }
}

TEST_CASE("bucket queue: the least and the greatest costs have buckets in their order") {
    CHECK(BucketQueue::bucket_of(0) == 0);
    CHECK(BucketQueue::bucket_of(Limits::denorm_min()) == 0);
    const std::vector<float> rising = {0, Limits::min(), 1, Limits::max(), Limits::infinity()};
    BucketQueue queue;
    for (std::size_t n = rising.size(); n-- > 0;) queue.push(rising[n], edge(n));
    for (std::size_t n = 0; n < rising.size(); ++n) {
        CHECK(queue.lowest_bucket() == BucketQueue::bucket_of(rising[n]));
        CHECK(queue.pop().i == n);
    }
    CHECK(queue.empty());
}

// Denormal costs share a bucket with 0, so they come in the order they were filed in.
TEST_CASE("bucket queue: within a bucket the edge that was filed first comes first") {
    BucketQueue queue;
    // 100 edges fill several chunks of the bucket and part of one.
    for (std::size_t n = 0; n < 100; ++n) queue.push(n % 2 ? 0 : Limits::denorm_min(), edge(n));
    for (std::size_t n = 0; n < 100; ++n) CHECK(queue.pop().i == n);
    CHECK(queue.empty());
}

TEST_CASE("bucket queue: an edge comes back as it was filed") {
    BucketQueue queue;
    queue.push(3, {.i = 7, .j = 4'000'000'000, .version_i = 65'535, .version_j = 9});
    const QueuedEdge out = queue.pop();
    CHECK(out.i == 7);
    CHECK(out.j == 4'000'000'000);
    CHECK(out.version_i == 65'535);
    CHECK(out.version_j == 9);
}

// While edges are worked off, cheaper ones are filed: the lowest bucket rises, falls and rises again.
TEST_CASE("bucket queue: the lowest bucket follows what is filed and taken") {
    BucketQueue queue;
    queue.push(8, edge(0));
    queue.push(2, edge(1));
    CHECK(queue.lowest_bucket() == BucketQueue::bucket_of(2));
    CHECK(queue.pop().i == 1);
    CHECK(queue.lowest_bucket() == BucketQueue::bucket_of(8));
    queue.push(0.5f, edge(2));
    queue.push(16, edge(3));
    CHECK(queue.lowest_bucket() == BucketQueue::bucket_of(0.5f));
    CHECK(queue.pop().i == 2);
    CHECK(queue.pop().i == 0);
    CHECK(queue.pop().i == 3);
    CHECK(queue.empty());
    queue.push(1, edge(4));  // below all that it has seen since it was empty
    CHECK(queue.pop().i == 4);
}

// The number of edges in it swings between none and some ten thousand, so chunks are worked off and used
// again in other buckets many times over, and several blocks of them are taken.
TEST_CASE("bucket queue: in long use the same as a list for each bucket") {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> exponent(-30, 30);
    BucketQueue queue;
    PlainQueue plain;
    std::size_t filed = 0;
    for (int swing = 0; swing < 6; ++swing) {
        // A few buckets, so that each has many chunks, then many buckets of few edges each.
        const bool few = swing % 2 == 0;
        for (int n = 0; n < 20'000; ++n) {
            const float cost = few ? 1 + static_cast<float>(random() % 4) : std::exp2(exponent(random));
            queue.push(cost, edge(filed));
            plain.push(cost, static_cast<Id>(filed++));
            if (n % 3 == 0) pop_both(queue, plain);
        }
        const bool to_the_end = swing % 3 == 2;
        for (int n = 0; to_the_end ? !plain.empty() : n < 10'000; ++n) pop_both(queue, plain);
    }
    while (!plain.empty()) pop_both(queue, plain);
}

TEST_CASE("bucket queue: cleared it is as new") {
    BucketQueue queue;
    PlainQueue plain;
    for (int round = 0; round < 3; ++round) {
        for (std::size_t n = 0; n < 5'000; ++n) queue.push(static_cast<float>(n % 50), edge(n));
        for (int n = 0; n < 1'000; ++n) queue.pop();
        queue.clear();
        CHECK(queue.empty());
        // What was left in it before must not come back.
        for (std::size_t n = 0; n < 5'000; ++n) {
            const float cost = static_cast<float>(n * 7 % 60);
            queue.push(cost, edge(100'000 + n));
            plain.push(cost, static_cast<Id>(100'000 + n));
        }
        while (!plain.empty()) pop_both(queue, plain);
    }
}
