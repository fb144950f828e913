// relation remove
#include "operations/relation/relation_operation.h"

#include <algorithm>

namespace ostraka {

namespace {

struct RelationRemove final : RelationOperation {
    void declare(Parameters& p) override {
        declare_inputs(p);
        declare_graph(p);
        declare_output(p);
        p.options("id", ids, "id of a relationship to remove, as shown by 'relation list'; repeatable").words().required();
        declare_relationships(p.report);
    }

    void run(Context&, Report& report) override {
        RelationGraph relations = read_relations();
        std::vector<Relationship> removed;
        for (const int id : ids) {
            const auto has_id = [&](const Relationship& relationship) { return relationship.id == id; };
            const auto place = std::find_if(relations.relationships.begin(), relations.relationships.end(), has_id);
            if (place != relations.relationships.end()) {
                removed.push_back(std::move(*place));
                relations.relationships.erase(place);
            } else if (std::none_of(removed.begin(), removed.end(), has_id)) {
                fail_input(graph.file(), "has no relationship " + std::to_string(id), "'ostraka relation list' shows them");
            }
        }
        output.write(std::move(relations), set());
        report_result(report, removed);
    }

    std::vector<int> ids;
};

}  // namespace

std::unique_ptr<Operation> make_relation_remove() { return make<RelationRemove>(); }

}  // namespace ostraka
