// relation extract
#include "operations/relation/relation_operation.h"

#include "ostraka/relation/geometric.h"
#include "ostraka/relation/part_of.h"
#include "ostraka/relation/topology.h"

#include <algorithm>

namespace ostraka {

namespace {

struct RelationExtract final : RelationOperation {
    void declare(Parameters& p) override {
        declare_inputs(p);
        declare_output(p);
        p.input_option("graph", Kind::graph, graph,
                       "existing graph (.graph.json); its user-specified relationships are copied to the output");
        Words told;
        for (const RelationType& type : relation_types())
            if (type.geometric) told.names.push_back(type.name);
        told.check = [](const std::string& name) { static_cast<void>(geometric_types({name})); };
        p.options("type", types, "type of relationship to detect; may be given more than once; all types if left out",
                  std::move(told))
            .words();
        p.input_option("vocabulary", Kind::vocabulary, vocabulary,
                       "vocabulary (.vocabulary.json, .ttl, .rdf) with part-whole relations: adds a relationship 'part of' "
                       "between a part and the annotated whole that contains it");
        tolerances.declare_options(p.options);
        p.report.table("tree", integer("annotation"), text("tag"), integer("depth"), integer("parent"));
        declare_relationships(p.report);
    }

    void run(Context&, Report& report) override {
        types = geometric_types(types);
        const RelationGraph old = read_relations();
        ExtractedRelations found =
            in_file(annotations.file(), [&] { return extract_relations(object(), old, types, tolerances); });
        for (const int id : found.stated) {
            const auto& list = found.graph.relationships;
            const auto known = std::find_if(list.begin(), list.end(), [&](const auto& one) { return one.id == id; });
            report.note("relationship " + std::to_string(id) + " (" + known->type + ") is stated already");
        }
        for (const std::string& note : found.notes) report.note(note);
        if (vocabulary)
            for (Relationship& part :
                 part_relationships(found.order, set(), vocabulary.load<Vocabulary>(read_vocabulary), free_id(found.graph)))
                if (find_equivalent(found.graph, part) == nullptr) found.graph.relationships.push_back(std::move(part));
        if (!found.skipped_types.empty())
            report.note("not searched, because the annotations have no upward direction: " + joined(found.skipped_types) +
                        " ('ostraka annotation edit --set-up x,y,z' sets it)");
        report.empty_table("tree");
        std::string text = "the whole shape\n";
        for (const auto& [place, depth] : containment_tree(found.order)) {
            const Annotation& annotation = set().annotations[place];
            Report::Row row = report.row("tree");
            row("annotation", annotation.id)("tag", annotation.tag)("depth", depth);
            if (const auto parent = found.order.parent[place]) row("parent", set().annotations[*parent].id);
            text += std::string(2 * depth + 2, ' ') + std::to_string(annotation.id) + " " + printable(annotation.tag) + " (" +
                    to_string(annotation.type) + ")\n";
        }
        report.line(text);
        report_result(report, found.graph.relationships);
        output.write(std::move(found.graph), set());
    }

    std::vector<std::string> types;
    RelationOptions tolerances;
    FileInput vocabulary;
};

}  // namespace

std::unique_ptr<Operation> make_relation_extract() { return make<RelationExtract>(); }

}  // namespace ostraka
