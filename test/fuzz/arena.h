// The folders in which runs take place, and the checks that nothing outside them is affected.
#pragma once

#include "subjects.h"

#include <string>
#include <vector>

namespace ostraka::fuzz {

/// seeds/ (initial files), output (of the run), and home/, where runs can write: work/ (the folder of the current run),
/// canaries/ (must not be changed), tmp/ (temporary files).
class Arena {
public:
    /// Creates the folders in the system's folder for temporary files, with canaries and seeds.
    explicit Arena(const Path& project);
    ~Arena();
    Arena(const Arena&) = delete;
    Arena& operator=(const Arena&) = delete;

    [[nodiscard]] Path seeds() const { return above_ / "seeds"; }

    /// Runs a subject with some of its files mutated.
    Verdict run(const Subject& subject, const std::vector<Change>& changes, double seconds);
    /// The beginning of the output of the last run.
    [[nodiscard]] std::string output() const;

private:
    void plant_canaries();
    [[nodiscard]] std::string look_at_canaries() const;
    double lay_out(const Subject& subject, const std::vector<Change>& changes) const;
    void apply(const Change& change) const;
    [[nodiscard]] std::string betrayed_in() const;
    void judge(Verdict& verdict);

    Path root_, above_, home_;
    std::string canaries_;  ///< original content
    double idle_ = 0;       ///< idle memory in bytes
};

}  // namespace ostraka::fuzz
