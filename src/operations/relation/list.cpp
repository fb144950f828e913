// relation list
#include "operations/relation/relation_operation.h"

namespace ostraka {

namespace {

struct RelationList final : RelationOperation {
    void declare(Parameters& p) override {
        describe_inputs(p);
        describe_graph(p);
        describe_relationships(p.report);
    }
    void run(Context&, Report& report) override { report_result(report, read_relations().relationships); }
};

}  // namespace

std::unique_ptr<Operation> make_relation_list() { return make<RelationList>(); }

}  // namespace ostraka
