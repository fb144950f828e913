// What every study has: a collection, the folder it writes to, and answers that are known.
#pragma once

#include "operations.h"

#include "ostraka/collection/object_part.h"

namespace ostraka {

class StudyFiles {
public:
    /// The slots and --plots; with `labels` also --truth, --truth-column and the members result.truth.
    void describe(Parameters& p, bool labels,
                  const std::string& collections = "folder of meshes, or a list of objects (.study.json)");
    /// Throws Error (usage) where the output folder is the collection's own.
    void check() const;
    /// Reads the collection (of a part of the work only its objects, unless `all`) and its labels, notes what they say, records
    /// both in the provenance, opens the folder. Throws as `read_collection`, `read_labels` and `set_labels` do.
    Collection read(Context& context, bool all = false) const;

    /// Where results of single objects are kept from run to run; `kind` is a folder in the output folder.
    [[nodiscard]] ResultStore store(const std::string& kind = "objects") const {
        return ResultStore(output.path() / kind, share_from_text(shard_));
    }
    /// Whether this run does a part of the objects only (--shard): then it says what became of them, and nothing is gathered.
    bool ends_with_part(Report& report, const std::vector<ObjectResult>& results) const;
    [[nodiscard]] bool is_part() const { return !share_from_text(shard_).is_whole(); }
    [[nodiscard]] const std::string& shard() const { return shard_; }
    [[nodiscard]] Path in(const std::string& name) const { return output.in(name); }
    /// A plot in the output folder, with the ending that was asked for.
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

/// Which part of the objects a study looks at.
class StudyPart {
public:
    void describe(Parameters& p) {
        options_.describe(p.options);
        vocabulary_.describe(p, "by which tags are compared with the names of parts");
    }
    void check() const {
        static_cast<void>(ObjectParts(options_));
        if (vocabulary_ && options_.annotations.empty() && options_.without.empty())
            fail_usage("--vocabulary is given without --annotation and --without", "name a part, or leave it away");
    }
    [[nodiscard]] ObjectParts parts() const { return ObjectParts(options_, vocabulary_.words(), vocabulary_.checksum()); }

private:
    PartOptions options_;
    VocabularyOption vocabulary_;
};

/// The table result.failed: the objects that failed or were left out, also as notes. Returns how many.
std::size_t report_failures(Report& report, const Collection& collection, const std::vector<ObjectResult>& results);

/// How many of the objects that were studied have a known answer.
struct KnownAnswers {
    std::size_t labelled = 0, objects = 0, kinds = 0;

    explicit KnownAnswers(const std::vector<std::string>& labels);
    /// Scores against the truth mean nothing for fewer than two objects, or objects of one kind.
    [[nodiscard]] bool scorable() const { return labelled >= 2 && kinds >= 2; }
    /// A line, "answers are known of 4 of 9 objects"; none where no answer is known.
    void report_result(Report& report) const;
    /// The member "truth" of a report; none where no answer is known.
    void add_to(Report& report) const;
};

/// `document_of` these, checked against the schema KIND.
void write_study_report(const Path& file, const std::string& kind, const JsonValue& result, const Provenance& provenance);

}  // namespace ostraka
