// ostraka annotation diff | merge
#include "command.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/exchange/difference.h"
#include "ostraka/io/mesh_file.h"

#include <iostream>
#include <memory>

namespace ostraka::app {

namespace {

AnnotationSet read_noted(const Session& session, const std::string& file, const Mesh& mesh,
                         const ReadAnnotationsOptions& options) {
    AnnotationSet set = read_annotations(file, mesh, options);
    for (const auto& note : set.notes) session.note("note: " + file + ": " + note);
    return set;
}

void add_name(JsonValue& entry, const std::optional<int>& id, const std::string& tag, const std::string& field,
              JsonAllocator& allocator) {
    if (id) {
        add_member(entry, "id", JsonValue(*id), allocator);
        add_member(entry, "tag", tag, allocator);
    }
    add_member(entry, "field", field, allocator);
}

struct Diff {
    std::string mesh, before, after;
    ReadAnnotationsOptions options;

    int run(const Session& session) const {
        Provenance provenance{"annotation diff", list_options(options), {}};
        for (const auto& file : {mesh, before, after}) provenance.add_input(file);
        const MeshFile file = read_mesh(mesh);
        const AnnotationSet a = read_noted(session, before, file.mesh, options),
                            b = read_noted(session, after, file.mesh, options);
        const std::vector<Difference> list = differences(a, b);
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType), entries(rapidjson::kArrayType);
        std::vector<std::vector<std::string>> rows;
        for (const Difference& difference : list) {
            const std::string kind = difference.kind == Difference::Kind::added     ? "added"
                                     : difference.kind == Difference::Kind::removed ? "removed"
                                                                                    : "changed";
            JsonValue entry(rapidjson::kObjectType);
            add_member(entry, "kind", kind, allocator);
            add_name(entry, difference.id, difference.tag, difference.field, allocator);
            add_member(entry, "before", difference.before, allocator);
            add_member(entry, "after", difference.after, allocator);
            std::string counts;
            if (difference.field == "geometry") {
                add_member(entry, "onlyBefore", JsonValue(static_cast<std::uint64_t>(difference.only_before)), allocator);
                add_member(entry, "onlyAfter", JsonValue(static_cast<std::uint64_t>(difference.only_after)), allocator);
                counts = " (-" + std::to_string(difference.only_before) + " +" + std::to_string(difference.only_after) + ")";
            }
            entries.PushBack(entry, allocator);
            rows.push_back({difference.id ? std::to_string(*difference.id) : "set", difference.tag, kind, difference.field,
                            difference.before, difference.after + counts});
        }
        add_member(result, "same", JsonValue(list.empty()), allocator);
        add_member(result, "differences", std::move(entries), allocator);
        if (session.json) session.print_report(provenance, document, result);
        else if (list.empty()) std::cout << "no difference\n";
        else std::cout << table({"id", "tag", "what", "field", "before", "after"}, rows);
        return list.empty() ? done : answer_is_no;
    }
};

struct Merge {
    std::string mesh, base, ours, theirs, output;
    ReadAnnotationsOptions reading;
    MergeOptions options;

    int run(const Session& session) const {
        check_outputs({mesh, base, ours, theirs}, {output});
        Provenance provenance{"annotation merge", list_options(options), {}};
        for (const auto& file : {mesh, base, ours, theirs}) provenance.add_input(file);
        const MeshFile file = read_mesh(mesh);
        const AnnotationSet b = read_noted(session, base, file.mesh, reading), o = read_noted(session, ours, file.mesh, reading),
                            t = read_noted(session, theirs, file.mesh, reading);
        const MergedAnnotations merged = merge_annotations(b, o, t, options);
        const bool settled = merged.settled(options);
        if (settled) write_annotations(output, merged.set, file.mesh, mesh, provenance);
        for (const auto& note : merged.notes) session.note("note: " + note);
        report(session, provenance, merged, settled);
        return settled ? done : answer_is_no;
    }

private:
    void report(const Session& session, const Provenance& provenance, const MergedAnnotations& merged, bool settled) const {
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType), list(rapidjson::kArrayType), notes(rapidjson::kArrayType);
        std::vector<std::vector<std::string>> rows;
        for (const Conflict& conflict : merged.conflicts) {
            JsonValue entry(rapidjson::kObjectType);
            add_name(entry, conflict.id, conflict.tag, conflict.field, allocator);
            add_member(entry, "base", conflict.base, allocator);
            add_member(entry, "ours", conflict.ours, allocator);
            add_member(entry, "theirs", conflict.theirs, allocator);
            list.PushBack(entry, allocator);
            rows.push_back({conflict.id ? std::to_string(*conflict.id) : "set", conflict.tag, conflict.field, conflict.base,
                            conflict.ours, conflict.theirs});
        }
        for (const auto& note : merged.notes) notes.PushBack(json_string(note, allocator), allocator);
        add_member(result, "merged", JsonValue(settled), allocator);
        add_member(result, "annotations", JsonValue(static_cast<std::uint64_t>(merged.set.annotations.size())), allocator);
        add_member(result, "conflicts", std::move(list), allocator);
        add_member(result, "notes", std::move(notes), allocator);
        if (session.json) {
            session.print_report(provenance, document, result);
            return;
        }
        if (!rows.empty()) std::cout << table({"id", "tag", "conflict", "base", "ours", "theirs"}, rows);
        const auto any = [&](const std::string& field) {
            return std::any_of(merged.conflicts.begin(), merged.conflicts.end(),
                               [&](const Conflict& conflict) { return conflict.field == field; });
        };
        if (!settled)
            std::cout << rows.size() << (rows.size() == 1 ? " conflict" : " conflicts")
                      << "; nothing written (settle them in the files, or choose with --prefer"
                      << (any("both added") ? "; --renumber keeps both where both added under one id" : "")
                      << (any("geometry") ? "; --merge-faces joins regions that both changed" : "") << ")\n";
        else
            std::cout << merged.set.annotations.size() << " annotations"
                      << (rows.empty() ? "" : ", conflicts settled for " + options.prefer) << '\n';
    }
};

}  // namespace

void add_annotation_merge(CLI::App& annotation, Session& session) {
    const auto diff = std::make_shared<Diff>();
    CLI::App* command = session.add(annotation, "diff", "what differs between two sets of annotations; exit code 3 if they do",
                                    [&session, diff] { return diff->run(session); });
    command->add_option("mesh", diff->mesh, "mesh of both")->required();
    command->add_option("before", diff->before, "annotations (.ant.json)")->required();
    command->add_option("after", diff->after, "annotations to compare with them")->required();
    add_flags(command, diff->options);

    const auto merge = std::make_shared<Merge>();
    command = session.add(annotation, "merge", "join two people's changes of one set; exit code 3 and no output with conflicts",
                          [&session, merge] { return merge->run(session); });
    command->add_option("mesh", merge->mesh, "mesh of all")->required();
    command->add_option("base", merge->base, "annotations that both began with")->required();
    command->add_option("ours", merge->ours, "one's annotations")->required();
    command->add_option("theirs", merge->theirs, "the other's annotations")->required();
    command->add_option("output", merge->output, "annotations to write")->required();
    add_flags(command, merge->reading);
    add_flags(command, merge->options);
}

}  // namespace ostraka::app
