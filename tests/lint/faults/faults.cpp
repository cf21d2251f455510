// One fault for each check of .clang-tidy, each on the line after its name. Nothing compiles this file but
// the linter, which must find all of them: tests/lint/lint.py.
#include <cassert>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace imgmesh {
namespace {

struct Base {
    Base();
    Base(const Base& other);
    virtual ~Base() = default;
    virtual int level() const { return 0; }
    std::string text;
};

struct Middle : Base {
    Middle() = default;
    // bugprone-copy-constructor-init
    Middle(const Middle& other) : name(other.name) {}
    int level() const override { return 1; }
    std::string name;
};

struct Leaf : Middle {
    // bugprone-parent-virtual-call
    int level() const override { return Base::level(); }
};

struct Moved {
    // performance-noexcept-move-constructor
    Moved(Moved&& other) : text(std::move(other.text)) {}
    std::string text;
};

// readability-identifier-naming
int BadName(int width, double share) {
    return width + static_cast<int>(share);
}

int rows_of(const std::vector<std::string>& rows, std::unique_ptr<int> owned) {
    int count = 0;
    // performance-for-range-copy
    for (const std::string row : rows) count += static_cast<int>(row.size());
    // performance-unnecessary-copy-initialization
    const std::string first = rows.front();
    // bugprone-unused-return-value
    owned.release();
    // bugprone-argument-comment
    count += BadName(/*height=*/count, 0.5);
    // bugprone-swapped-arguments
    count += BadName(0.5, count);
    // no check's: an assert() that changes something
    assert(++count > 0);
    // bugprone-misplaced-widening-cast
    const auto wide = static_cast<std::ptrdiff_t>(count * count);
    // bugprone-sizeof-expression
    const std::size_t bytes = sizeof(rows.data()) / sizeof(&count);
    // the compiler's: a view of what is gone
    const std::string_view view = std::string("gone");
    // performance-move-const-arg
    const std::size_t size = std::move(first).size() + std::move(count);
    return static_cast<int>(wide) + static_cast<int>(bytes + view.size() + size + first.size());
}

}  // namespace
}  // namespace imgmesh
