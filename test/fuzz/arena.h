// The folders in which runs take place, and what must not happen outside them.
#pragma once

#include "subjects.h"

#include <string>
#include <vector>

namespace ostraka::fuzz {

/// seeds/ (what runs begin with), said (what the run had to say), and home/, where runs can write: work/ (the folder of the run
/// under way), canaries/ (what nobody may touch), tmp/ (for temporary files).
class Arena {
public:
    /// Makes it anew, in the system's folder for temporary files, with canaries and seeds.
    explicit Arena(const Path& project);
    ~Arena();
    Arena(const Arena&) = delete;
    Arena& operator=(const Arena&) = delete;

    [[nodiscard]] Path seeds() const { return above_ / "seeds"; }

    /// Runs a subject with some of its files changed.
    Verdict run(const Subject& subject, const std::vector<Change>& changes, double seconds);
    /// The beginning of what the last run had to say.
    [[nodiscard]] std::string said() const;

private:
    void plant_canaries();
    [[nodiscard]] std::string look_at_canaries() const;
    double lay_out(const Subject& subject, const std::vector<Change>& changes) const;
    void apply(const Change& change) const;
    [[nodiscard]] std::string betrayed_in() const;
    void judge(Verdict& verdict);

    Path root_, above_, home_;
    std::string canaries_;  ///< as they are
    double idle_ = 0;       ///< bytes
};

}  // namespace ostraka::fuzz
