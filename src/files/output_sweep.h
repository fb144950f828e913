// Finds and removes files that an earlier run wrote into a folder and the current run did not write again.
#pragma once

#include "ostraka/files/file.h"

#include <map>

namespace ostraka {

class OutputSweep {
public:
    /// `pending`: temporary names and final names of the files about to be renamed; `kept_inputs`: input files, which are not
    /// removed and are dropped from the list.
    OutputSweep(const Path& folder, const std::string& owner, const std::vector<std::pair<Path, Path>>& pending,
                const std::vector<Path>& kept_inputs);

    /// Writes the list of the files written now and the files still to be removed, so that no file is forgotten if the run is
    /// killed before remove_obsolete. The list is part of the open transaction.
    void write_list() const;
    /// Removes the files that were not written again, and writes the list without the removed files.
    void remove_obsolete();

private:
    [[nodiscard]] std::string text() const;

    Path folder_, list_;
    /// File name -> SHA-256, of the files written by this run and of the files to be removed.
    std::map<std::string, std::string> written_, obsolete_;
};

}  // namespace ostraka
