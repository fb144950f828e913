// relation export
#include "operations/relation/relation_operation.h"

#include "ostraka/figures/bracket_graph.h"
#include "ostraka/relation/layout.h"
#include "ostraka/relation/topology.h"

#include <algorithm>
#include <map>

namespace ostraka {

namespace {

struct RelationExport final : RelationOperation {
    void declare(Parameters& p) override {
        declare_inputs(p);
        declare_graph(p);
        p.output("output", Kind::text, output, "drawing to write (.svg, .pdf, .png), or a file for Graphviz (.dot, .gv)");
        for (const char* count : {"relationships", "annotations"}) p.report.values(integer(count, count));
    }

    void check() const override {
        const std::string kind = extension(output.file());
        const std::initializer_list<const char*> known{".dot", ".gv", ".svg", ".pdf", ".png"};
        if (!output.file().empty() && std::find(known.begin(), known.end(), kind) == known.end())
            fail_usage("'" + output.file() + "' is neither a drawing nor a Graphviz file",
                       "end its name in .svg, .pdf, .png, .dot or .gv");
    }

    void run(Context&, Report& report) override {
        const RelationGraph relations = read_relations();
        const std::string kind = extension(output.file());
        if (kind == ".svg" || kind == ".pdf" || kind == ".png") write_plot(output.path(), drawn(relations));
        else output.write(graph_to_dot(relations, set()));
        report("relationships", relations.relationships.size())("annotations", set().annotations.size());
    }

    [[nodiscard]] BracketGraph drawn(const RelationGraph& relations) {
        const GraphLayout layout = layout_of(relations, set(), topology(object()).order);
        BracketGraph drawing;
        std::map<int, std::size_t> row_of;
        for (const TreeEntry& row : layout.rows) {
            const Annotation& one = set().annotations[row.annotation];
            row_of[one.id] = drawing.rows.size();
            const auto channel = [&](std::size_t k) { return static_cast<std::uint8_t>(std::clamp(one.colour[k], 0, 255)); };
            drawing.rows.push_back({one.tag.empty() ? "annotation " + std::to_string(one.id) : one.tag,
                                    static_cast<int>(row.depth),
                                    {channel(0), channel(1), channel(2)}});
        }
        for (std::size_t i = 0; i < layout.lanes.size(); ++i) {
            if (!layout.lanes[i]) continue;
            const Relationship& one = relations.relationships[i];
            BracketGraph::Bracket& bracket = drawing.brackets.emplace_back();
            bracket.type = one.type;
            bracket.lane = *layout.lanes[i];
            bracket.strong = one.is_constraint;
            bracket.directed = one.directed;
            for (const int id : one.annotations)
                if (const auto at = row_of.find(id); at != row_of.end()) bracket.rows.push_back(at->second);
        }
        return drawing;
    }

    FileOutput output{".dot"};
};

}  // namespace

std::unique_ptr<Operation> make_relation_export() { return make<RelationExport>(); }

}  // namespace ostraka
