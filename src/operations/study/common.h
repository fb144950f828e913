// Common to all studies: a collection, the output folder, and known answers.
#pragma once

#include "operations/operations.h"

#include "ostraka/collection/object_part.h"

namespace ostraka {

class StudyFiles {
public:
    /// Declares the slots and --plots; with `labels` also --truth, --truth-column and the members result.truth.
    void declare(Parameters& p, bool labels,
                 const std::string& collections = "folder of meshes, or a list of objects (.study.json)");
    /// Throws Error (usage) if the output folder is the folder of the collection.
    void check() const;
    /// Reads the collection (only the objects of the shard, unless `all`) and its labels, reports their notes, records both in
    /// the provenance, and opens the output folder. Throws as `read_collection`, `read_labels` and `set_labels` do.
    /// `landmarks`: landmark files of every format belong to the objects (`read_landmark_collection`).
    Collection read(Context& context, bool all = false, bool landmarks = false) const;

    /// Store of per-object results that persists between runs; `kind` is a folder in the output folder.
    [[nodiscard]] ResultStore store(const std::string& kind = "objects") const {
        return ResultStore(output.path() / kind, parse_shard(shard_));
    }
    /// Whether this run processes one shard of the objects only (--shard): then it reports their state, and no results are
    /// gathered.
    bool ends_with_part(Report& report, const std::vector<ObjectResult>& results) const;
    [[nodiscard]] bool is_part() const { return !parse_shard(shard_).is_whole(); }
    [[nodiscard]] const std::string& shard() const { return shard_; }
    [[nodiscard]] Path in(const std::string& name) const { return output.in(name); }
    /// Path of a plot in the output folder, with the extension of the requested format.
    [[nodiscard]] Path plot(const std::string& name) const {
        return in(name + (plots_ == PlotFormat::png ? ".png" : plots_ == PlotFormat::pdf ? ".pdf" : ".svg"));
    }

    FileInput collection;
    FolderOutput output;

private:
    enum class PlotFormat { svg, pdf, png };
    FileInput truth_;
    std::string truth_column_, shard_;
    bool own_truth_ = false;
    PlotFormat plots_ = PlotFormat::svg;
};

/// An operation on a collection.
struct StudyOperation : Operation {
    void check() const override { files.check(); }

    StudyFiles files;
};

/// The part of each object that a study examines.
class StudyPart {
public:
    void declare(Parameters& p) {
        options_.declare_options(p.options);
        vocabulary_.declare(p, "used to match tags of annotations with the names of parts");
    }
    void check() const {
        static_cast<void>(ObjectParts(options_));
        if (vocabulary_ && options_.annotations.empty() && options_.without.empty())
            fail_usage("--vocabulary is given without --annotation and --without", "name a part, or leave it out");
    }
    [[nodiscard]] ObjectParts parts() const { return ObjectParts(options_, vocabulary_.words(), vocabulary_.checksum()); }

private:
    PartOptions options_;
    VocabularyOption vocabulary_;
};

/// Fills the table result.failed with the objects that failed or were left out, also as notes. Returns their number.
std::size_t report_failures(Report& report, const Collection& collection, const std::vector<ObjectResult>& results);

/// The number of studied objects whose answer is known.
struct KnownAnswers {
    std::size_t labelled = 0, objects = 0, kinds = 0;

    explicit KnownAnswers(const std::vector<std::string>& labels);
    /// Whether scores are meaningful: at least two labelled objects, of at least two kinds.
    [[nodiscard]] bool scorable() const { return labelled >= 2 && kinds >= 2; }
    /// Adds the line "answers are known of 4 of 9 objects"; nothing if no answer is known.
    void report_result(Report& report) const;
    /// Adds the member "truth"; nothing if no answer is known.
    void add_to(Report& report) const;
};

/// Writes `document_of` the arguments, after validation against the schema KIND.
void write_study_report(const Path& file, const std::string& kind, const JsonValue& result, const Provenance& provenance);

}  // namespace ostraka
