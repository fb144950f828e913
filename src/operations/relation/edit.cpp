// relation edit
#include "operations/relation/relation_operation.h"

#include "ostraka/semantic/deform.h"

#include <algorithm>
#include <optional>

namespace ostraka {

namespace {

struct RelationEdit final : RelationOperation {
    void declare(Parameters& p) override {
        declare_inputs(p);
        declare_graph(p);
        declare_output(p);
        p.options("id", id, "id of the relationship, as shown by 'relation list'", Range{0, 2147483647}).required();
        p.options("weight", weight, "weight of the relationship as a constraint; with weight 0 the constraint is not used",
                  Range{0, 1e300});
        p.options("range", range, "MIN,MAX: new values of minValue and maxValue of the constraint");
        p.options("parameters", parameters,
                  "JSON object whose members replace the parameters of the constraint; null removes a parameter");
        p.options("constraint", constraint, "true: the relationship is a constraint on deformations",
                  Choices{"unchanged", "yes", "no"});
        declare_relationships(p.report);
    }

    void check() const override {
        if (!weight && range.empty() && parameters.empty() && constraint == Constrains::unchanged)
            fail_usage("no change is given", "give --weight, --range, --parameters or --constraint");
        if (!range.empty()) {
            const std::vector<double> ends = numbers_of<double>(range, "--range");
            if (ends.size() != 2 || !(ends[0] <= ends[1]))
                fail_usage("--range is '" + printable(range, 60) + "'", "give two numbers, the smaller first: 1.5,2");
        }
        if (!parameters.empty() && !parse_json(parameters, "--parameters").IsObject())
            fail_usage("--parameters is no JSON object", "write {\"hard\": true}, for example");
    }

    void run(Context&, Report& report) override {
        RelationGraph relations = read_relations();
        const auto found = std::find_if(relations.relationships.begin(), relations.relationships.end(),
                                        [&](const Relationship& one) { return one.id == id; });
        if (found == relations.relationships.end())
            fail_input(graph.file(), "has no relationship " + std::to_string(id), "'ostraka relation list' shows them");
        Relationship changed = *found;
        if (weight) changed.weight = *weight;
        if (constraint != Constrains::unchanged) changed.is_constraint = constraint == Constrains::yes;
        if (!range.empty() || !parameters.empty()) {
            if (constraint != Constrains::no) changed.is_constraint = true;
            Json object = changed.constraint.empty() ? parse_json("{}", "the constraint")
                                                     : parse_json(changed.constraint, "the constraint");
            const auto set_member = [&](const std::string& name, JsonValue value) {
                object.RemoveMember(name.c_str());
                if (!value.IsNull()) add_member(object, name, std::move(value), object.GetAllocator());
            };
            if (!parameters.empty())
                for (const Json given = parse_json(parameters, "--parameters"); const auto& member : given.GetObject())
                    set_member(member.name.GetString(), JsonValue(member.value, object.GetAllocator()));
            if (!range.empty()) {
                const std::vector<double> ends = numbers_of<double>(range, "--range");
                set_member("minValue", JsonValue(ends[0]));
                set_member("maxValue", JsonValue(ends[1]));
            }
            changed.constraint = object.MemberCount() == 0 ? std::string() : to_compact_text(object);
        }
        // Changed by a person: further extractions must keep it.
        changed.origin = "stated";
        *found = changed;
        check_graph(relations, set(), output.file());
        if (changed.is_constraint) check_constraint(object(), changed, output.file());
        output.write(std::move(relations), set());
        report_result(report, std::vector<Relationship>{changed});
    }

    enum class Constrains { unchanged, yes, no };
    int id = -1;
    std::optional<double> weight;
    std::string range, parameters;
    Constrains constraint = Constrains::unchanged;
};

}  // namespace

std::unique_ptr<Operation> make_relation_edit() { return make<RelationEdit>(); }

}  // namespace ostraka
