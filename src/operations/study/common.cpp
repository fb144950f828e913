#include "operations/study/common.h"

#include <fmt/core.h>

#include <set>

namespace ostraka {

void StudyFiles::declare(Parameters& p, bool labels, const std::string& collections) {
    p.input("collection", Kind::collection, collection, collections);
    p.output("output", Kind::folder, output, "folder for tables, plots and report; finished results in it are reused").flag();
    p.options("plots", plots_, "format of the plots", Choices{"svg", "pdf", "png"}).unrecorded();
    p.options("shard", shard_, "K/N: process and store the K-th of N shards of the objects; if left out, results are gathered")
        .unrecorded();
    p.report.table("failed", text("name"), text("problem"));
    p.report.values(integer("part.objects"), integer("part.failed"));
    if (!labels) return;
    p.input_option("truth", Kind::table, truth_, "known answers: CSV with the columns name and label");
    p.options("own-truth", own_truth_,
              "use the known answers in truth.csv in the folder of the collection, as written by 'study make'");
    p.options("truth-column", truth_column_, "name of the column with the known answers; 'label' if left out");
    p.report.values(integer("truth.labelled"), integer("truth.objects"), integer("truth.kinds"));
}

void StudyFiles::check() const {
    static_cast<void>(parse_shard(shard_));
    const Path &collection_path = collection.sources.front().file, &output_folder = output.sources.front().file;
    if (!collection_path.empty() && !output_folder.empty() &&
        same_place(output_folder, is_folder(collection_path) ? collection_path : collection_path.parent_path()))
        fail_usage("--output is the folder of the collection",
                   "name another folder, so that results are not mistaken for objects");
    if (truth_ && own_truth_) fail_usage("--truth and --own-truth", "give one of them");
    if (!truth_ && !own_truth_ && !truth_column_.empty()) fail_usage("--truth-column without --truth", "name the table as well");
}

Collection StudyFiles::read(Context& context, bool all, bool landmarks) const {
    Collection result;
    context.record([&] {
        const Share share = all ? Share() : parse_shard(shard_);
        result = landmarks ? read_landmark_collection(collection.path(), share) : read_collection(collection.path(), share);
        if (truth_) set_labels(result, read_labels(truth_.path(), truth_column_), truth_.file());
        if (own_truth_) {
            const Path table = collection.path() / "truth.csv";
            set_labels(result, read_labels(table, truth_column_), table.string());
            context.record_input("truth.csv", sha256_of_file(table));
        }
    });
    output.open();
    for (const auto& object : result.objects)
        if (!object.checksum.empty() || !is_part()) context.record_input(object.name, object.checksum);
    context.notes("", result.notes);
    return result;
}

bool StudyFiles::ends_with_part(Report& report, const std::vector<ObjectResult>& results) const {
    if (!is_part()) return false;
    std::size_t objects = 0, failed = 0;
    for (const ObjectResult& result : results)
        if (!result.elsewhere) ++objects, failed += result.problem.empty() ? 0 : 1;
    report("part.objects", objects)("part.failed", failed);
    report.line(fmt::format("shard {}: {}{}; once all shards are done, run it without --shard to gather them", shard_,
                            counted(objects, "object"), failed > 0 ? fmt::format(", {} failed", failed) : ""));
    return true;
}

std::size_t report_failures(Report& report, const Collection& collection, const std::vector<ObjectResult>& results) {
    std::size_t count = 0;
    report.empty_table("failed");
    const auto add = [&](const std::string& name, const std::string& problem) {
        report.note(fmt::format("left out: {}{}", problem.starts_with(name + ": ") ? "" : name + ": ", problem));
        report.row("failed")("name", name)("problem", problem);
        ++count;
    };
    for (const auto& [name, problem] : collection.left_out) add(name, problem);
    for (std::size_t i = 0; i < results.size(); ++i)
        if (!results[i].problem.empty()) add(collection.objects[i].name, results[i].problem);
    return count;
}

KnownAnswers::KnownAnswers(const std::vector<std::string>& labels) : objects(labels.size()) {
    std::set<std::string> distinct_labels;
    for (const auto& label : labels) {
        if (label.empty()) continue;
        ++labelled;
        distinct_labels.insert(label);
    }
    kinds = distinct_labels.size();
}

void KnownAnswers::report_result(Report& report) const {
    if (labelled == 0) return;
    std::string text = fmt::format("answers are known for {} of {} objects", labelled, objects);
    if (!scorable()) text += labelled < 2 ? ": too few for scores" : ", all of one kind: no scores are possible";
    report.line(text);
}

void KnownAnswers::add_to(Report& report) const {
    if (labelled > 0) report("truth.labelled", labelled)("truth.objects", objects)("truth.kinds", kinds);
}

void write_study_report(const Path& file, const std::string& kind, const JsonValue& result, const Provenance& provenance) {
    const Json document = document_of(kind, result, provenance);
    validate(document, kind, file.string());
    write_json(file, document);
}

}  // namespace ostraka
