#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "libcore/base/error.h"
#include "tools/common/memory.h"

using namespace imgmesh;

TEST_CASE("parse_memory: bytes, and powers of 1000") {
    CHECK(parse_memory("--m", "1") == 1);
    CHECK(parse_memory("--m", "1234567") == 1234567);
    CHECK(parse_memory("--m", "2k") == 2000);
    CHECK(parse_memory("--m", "1.5G") == 1500000000);
    CHECK(parse_memory("--m", "3T") == 3000000000000);
    for (const char* text : {"", "k", "0", "-1", "2K", "2GB", "2 G", "nan", "inf", "1e30", "0x10"}) {
        CAPTURE(text);
        CHECK_THROWS_AS(parse_memory("--m", text), Error);
    }
}

TEST_CASE("check_memory: the need, the limit and what it is for in one line") {
    CHECK_NOTHROW(check_memory("a.png: work", 100, 100));
    try {
        check_memory("a.png: work", 2.5e9, 1'000'000'000);
        FAIL("no error");
    } catch (const Error& e) {
        CHECK(e.kind() == ErrorKind::kBadFile);
        CHECK(std::string(e.what()) == "a.png: work takes about 2.5 GB of memory, --max-memory is 1.0 GB");
    }
}

TEST_CASE("usual_max_memory: there is some, and no machine has as much as all numbers") {
    CHECK(usual_max_memory() > 100'000'000);
    CHECK(usual_max_memory() < 1'000'000'000'000'000);
}

TEST_CASE("MemoryGate: jobs together keep to the limit, and one alone may enter whatever it takes") {
    MemoryGate gate(100);
    std::atomic<int> taken = 0, most = 0, wrong = 0;
    {
        std::vector<std::jthread> jobs;
        for (int i = 0; i < 8; ++i)
            jobs.emplace_back([&, bytes = i == 3 ? 300 : 40] {
                const MemoryGate::Share share(gate, bytes);
                const int now = taken += bytes;
                for (int seen = most; seen < now && !most.compare_exchange_weak(seen, now);) {
                }
                wrong += now <= 100 || now == 300 ? 0 : 1;
                std::this_thread::sleep_for(std::chrono::milliseconds(5));
                taken -= bytes;
            });
    }
    CHECK(wrong == 0);
    CHECK(most == 300);
    CHECK(taken == 0);
}
