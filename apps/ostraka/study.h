// What every study has: a collection, the folder it writes to, and answers that are known.
#pragma once

#include "command.h"

#include "ostraka/collection/objects.h"

namespace ostraka::app {

struct StudyFiles {
    std::string collection, output, truth, truth_column, plots = "svg";

    /// Throws Error (usage) where the output folder is the collection's own or a file.
    void check() const;
    /// Makes the output folder; what an earlier run of this command left in it goes where this one does not write it again.
    void open(const Provenance& provenance) const;
    /// Reads the collection and its labels, says their notes, records both in the provenance, opens the folder. Throws as
    /// `check`, and Error (input) as `read_collection`, `read_labels` and `set_labels` do.
    [[nodiscard]] Collection read(const Session& session, Provenance& provenance) const;
    /// Where results of single objects are kept from run to run; `kind` is a folder in the output folder.
    [[nodiscard]] ResultStore store(const std::string& kind = "objects") const;
    /// A file in the output folder.
    [[nodiscard]] Path in(const std::string& name) const { return Path(output) / name; }
    /// A plot in the output folder, with the ending that was asked for.
    [[nodiscard]] Path plot(const std::string& name) const { return in(name + "." + plots); }
};

/// The collection as argument; --output, --plots, and with `labels` --truth and --truth-column.
void add_study_files(CLI::App* command, StudyFiles& files, bool labels);

/// The objects that failed or were left out, for the report (members name, problem) and as notes on standard error. Returns how
/// many.
std::size_t report_failures(const Session& session, const Collection& collection, const std::vector<ObjectResult>& results,
                            JsonValue& report, JsonAllocator& allocator);

/// How many of the objects that were studied have a known answer.
struct KnownAnswers {
    std::size_t labelled = 0, objects = 0, kinds = 0;

    explicit KnownAnswers(const std::vector<std::string>& labels);
    /// Scores against the truth mean nothing for fewer than two objects, or objects of one kind.
    [[nodiscard]] bool scorable() const { return labelled >= 2 && kinds >= 2; }
    /// "answers are known of 4 of 9 objects", a line; empty where none is.
    [[nodiscard]] std::string words() const;
    /// The member "truth" of a report; none where no answer is known.
    void add_to(JsonValue& report, JsonAllocator& allocator) const;
};

/// {"format": "ostraka-KIND", "version", members of `result`, "provenance"}, checked against the schema KIND.
void write_study_report(const Path& file, const std::string& kind, const JsonValue& result, const Provenance& provenance);

/// Makes the folder for a made collection. Throws Error (failure) where it holds objects or a truth table already: made objects
/// would be mixed with them.
void make_collection_folder(const std::string& folder);

}  // namespace ostraka::app
