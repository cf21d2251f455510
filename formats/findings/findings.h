// Collects the findings of checks: a reader stops at the first error, a validator continues.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "formats/findings/finding_error.h"
#include "formats/findings/issue.h"

namespace imgmesh {

class Findings {
  public:
    /// Throws a FindingError at the first error and ignores warnings and infos.
    static Findings strict() { return Findings(false); }
    /// Keeps all findings.
    static Findings collecting() { return Findings(true); }

    /// Returns whether warnings and infos are wanted; otherwise their checks need not run.
    bool collects() const { return collects_; }
    /// Returns the issue's index in issues().
    std::size_t add(FindingCode code, const std::string& text, Place place = {});
    /// Returns the number of errors so far.
    std::size_t errors() const { return errors_; }
    std::vector<Issue>& issues() { return issues_; }

    /// Runs `check`, whose places are relative to `pointer`. A FindingError is passed on for a reader; a
    /// validator keeps it and continues. Returns whether the check came to its end.
    template <typename Check>
    bool attempt(const std::string& pointer, Check&& check) {
        const std::string outer = std::exchange(base_, pointer);
        bool done = true;
        try {
            check();
        } catch (const FindingError& error) {
            if (!collects_) throw;
            add(error.finding(), error.what(), error.place());
            done = false;
        } catch (...) {
            base_ = outer;
            throw;
        }
        base_ = outer;
        return done;
    }

  private:
    explicit Findings(bool collects) : collects_(collects) {}

    bool collects_;
    std::size_t errors_ = 0;
    std::string base_;
    std::vector<Issue> issues_;
};

/// A defect that may occur at every pixel or vertex: reported once, with its first place and its count.
class Repeated {
  public:
    Repeated(Findings& findings, FindingCode code) : findings_(findings), code_(code) {}

    /// `describe` gives the text and the place, and is called only the first time.
    template <typename Describe>
    void hit(Describe&& describe) {
        if (count_++ == 0) {
            const std::pair<std::string, Place> first = describe();
            index_ = findings_.add(code_, first.first, first.second);
        } else if (findings_.collects()) {
            findings_.issues()[index_].count = count_;
        }
    }

  private:
    Findings& findings_;
    FindingCode code_;
    std::uint64_t count_ = 0;
    std::size_t index_ = 0;
};

}  // namespace imgmesh
