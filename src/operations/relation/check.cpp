// relation check
#include "operations/relation/relation_operation.h"

#include "ostraka/relation/rules.h"
#include "ostraka/semantic/measure_constraints.h"

#include <array>
#include <set>

namespace ostraka {

namespace {

struct RelationCheckAll final : RelationOperation {
    void declare(Parameters& p) override {
        declare_inputs(p);
        declare_graph(p);
        p.input_option("rest", Kind::mesh, rest,
                       "the same mesh before the deformation (rest shape); constraints that preserve a quantity compare with it");
        p.input_option("rules", Kind::rules, rules, "rules of the class (.rules.json) that the annotations must satisfy");
        p.input_option("vocabulary", Kind::vocabulary, vocabulary,
                       "vocabulary (.vocabulary.json, .ttl, .rdf): a rule for a concept also applies to narrower concepts");
        tolerances.declare_options(p.options);
        declare_relationships(p.report, true);
        for (const char* verdict : {"holds", "fails", "unknown"}) p.report.values(integer(verdict));
        p.report.table("rules", text("rule", "rule"), integer("annotation", "id"), text("part", "part"), text("text", "broken"));
        p.report.values(boolean("conforms"));
    }

    void check() const override {
        if (vocabulary && !rules) fail_usage("--vocabulary needs --rules", "add --rules FILE");
    }

    void run(Context&, Report& report) override {
        const RelationGraph relations = read_relations();
        const std::vector<RelationCheck> checks = in_file(rest ? rest.file() : annotations.file(), [&] {
            return judge_relationships(object(), relations, rest ? &rest->mesh : nullptr, tolerances, graph.file());
        });
        std::array<std::size_t, 3> counts{};
        report.empty_table("relationships");
        for (std::size_t i = 0; i < checks.size(); ++i) {
            Relationship relationship = relations.relationships[i];
            relationship.parameters = checks[i].parameters;
            ++counts.at(static_cast<std::size_t>(checks[i].verdict));
            report_result(report, relationship)("verdict", to_string(checks[i].verdict))("text", checks[i].text);
        }
        for (const Verdict verdict : {Verdict::holds, Verdict::fails, Verdict::unknown})
            report(to_string(verdict), counts.at(static_cast<std::size_t>(verdict)));
        report.line(std::to_string(counts[0]) + " hold, " + std::to_string(counts[1]) + " fail, " + std::to_string(counts[2]) +
                    " unknown");
        const std::size_t broken = rules ? report_rules(report, relations) : 0;
        const bool conforms = counts[1] + broken == 0;
        report("conforms", conforms);
        if (!conforms) report.answer_no();
    }

    /// Reports the violated rules; returns their number.
    std::size_t report_rules(Report& report, const RelationGraph& relations) const {
        const ClassRules& kept = rules.load<ClassRules>(read_class_rules);
        const Vocabulary* words = vocabulary ? &vocabulary.load<Vocabulary>(read_vocabulary) : nullptr;
        const std::vector<RuleViolation> broken = broken_rules(object(), kept, words, &relations, rules.file());
        report.empty_table("rules");
        std::set<std::string> names;
        for (const RuleViolation& one : broken) {
            names.insert(one.rule);
            Report::Row row = report.row("rules");
            row("rule", one.rule)("text", one.text);
            if (!one.annotation) continue;
            row("annotation", *one.annotation)("part", set().find(*one.annotation)->tag);
        }
        report.line(counted(names.size(), "rule") + " of " + std::to_string(kept.rules.size()) + " for '" +
                    printable(kept.object_class, 60) + "' broken");
        return names.size();
    }

    FileInput rules, vocabulary;
    MeshInput rest;
    RelationOptions tolerances;
};

}  // namespace

std::unique_ptr<Operation> make_relation_check() { return make<RelationCheckAll>(); }

}  // namespace ostraka
