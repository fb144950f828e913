// relation list
#include "operations/relation/relation_operation.h"

namespace ostraka {

namespace {

struct RelationList final : RelationOperation {
    void declare(Parameters& p) override {
        declare_inputs(p);
        declare_graph(p);
        declare_relationships(p.report);
    }
    void run(Context&, Report& report) override { report_result(report, read_relations().relationships); }
};

}  // namespace

std::unique_ptr<Operation> make_relation_list() { return make<RelationList>(); }

}  // namespace ostraka
