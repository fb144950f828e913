// What an earlier run wrote into a folder, and this one did not.
#pragma once

#include "ostraka/core/file.h"

#include <map>

namespace ostraka {

class OutputSweep {
public:
    /// `waiting`: temporary names and names of the files that are about to appear; `kept`: files that stay, and are forgotten.
    OutputSweep(const Path& folder, const std::string& owner, const std::vector<std::pair<Path, Path>>& waiting,
                const std::vector<Path>& kept);

    /// The list of what is written now and of what is still to be removed, so that a run that is killed in between forgets
    /// nothing. Joins the open transaction.
    void write_list() const;
    /// Removes the files that were not written again, and writes the list without them.
    void remove_rest();

private:
    [[nodiscard]] std::string text() const;

    Path folder_, list_;
    std::map<std::string, std::string> now_, rest_;  ///< name, SHA-256
};

}  // namespace ostraka
