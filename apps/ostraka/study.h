// What every study has: a collection, the folder it writes to, and answers that are known.
#pragma once

#include "command.h"

#include "ostraka/collection/objects.h"

namespace ostraka::app {

struct StudyFiles {
    std::string collection, output, truth, truth_column;

    /// Reads the collection and its labels, says their notes, records both in the provenance. Throws Error (usage) where the
    /// output folder is the collection's own or a file, Error (input) as `read_collection` and `read_labels` do.
    [[nodiscard]] Collection read(const Session& session, Provenance& provenance) const;
    /// Where results of single objects are kept from run to run; `kind` is a folder in the output folder.
    [[nodiscard]] ResultStore store(const std::string& kind = "objects") const;
    /// A file in the output folder, which is made if it is missing.
    [[nodiscard]] Path in(const std::string& name) const;
};

/// The collection as argument; --output, and with `labels` --truth and --truth-column.
void add_study_files(CLI::App* command, StudyFiles& files, bool labels);

/// The objects that failed, for the report (members name, problem) and as notes on standard error. Returns how many.
std::size_t report_failures(const Session& session, const Collection& collection, const std::vector<ObjectResult>& results,
                            JsonValue& report, JsonAllocator& allocator);

}  // namespace ostraka::app
