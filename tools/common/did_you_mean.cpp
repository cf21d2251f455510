#include "tools/common/did_you_mean.h"

#include <algorithm>
#include <string_view>

namespace imgmesh {
namespace {

// Longer ones are no words that somebody mistyped, and would take time in proportion to their length.
constexpr std::size_t kLongestWord = 60;

std::string bare(std::string_view word) {
    word.remove_prefix(std::min(word.find_first_not_of('-'), word.size()));
    std::string lower(word);
    std::ranges::transform(lower, lower.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return lower;
}

// The number of edits from one word to another, with neighbours swapped as one ("optimal string alignment").
std::size_t edits(const std::string& a, const std::string& b) {
    std::vector<std::size_t> before, last(b.size() + 1), now(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        now[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            now[j] = std::min({last[j] + 1, now[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                now[j] = std::min(now[j], before[j - 2] + 1);
        }
        before = last;
        last = now;
    }
    return last[b.size()];
}

}  // namespace

std::string nearest_word(const std::string& typed, const std::vector<std::string>& words) {
    constexpr std::size_t kLeastPrefix = 3;
    const std::string given = bare(typed);
    if (given.empty() || given.size() > kLongestWord) return "";
    // One letter of three may be wrong, at most three in all.
    std::size_t least = std::min<std::size_t>((given.size() + 2) / 3, 3) + 1;
    std::string best, longer;
    for (const std::string& word : words) {
        const std::string candidate = bare(word);
        const std::size_t distance = edits(given, candidate);
        // Where all letters are wrong, nothing was mistyped.
        if (distance < least && distance < std::max(given.size(), candidate.size())) {
            least = distance;
            best = word;
        }
        const bool is_shorter = longer.empty() || word.size() < longer.size();
        if (is_shorter && given.size() >= kLeastPrefix && candidate.starts_with(given)) longer = word;
    }
    return least > 1 && !longer.empty() ? longer : best;
}

std::string did_you_mean(const std::string& typed, const std::vector<std::string>& words) {
    const std::string word = nearest_word(typed, words);
    return word.empty() ? "" : "; did you mean " + word + "?";
}

}  // namespace imgmesh
