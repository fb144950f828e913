// annotation check
#include "operations.h"

#include "ostraka/measure/examine.h"
#include "ostraka/relation/part_of.h"
#include "ostraka/relation/rules.h"

namespace ostraka {

namespace {

struct AnnotationCheck final : Operation {
    void describe(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file");
        p.input("annotations", Kind::annotations, annotations, "its annotations (.ant.json)");
        reading.describe(p.options);
        p.input_option("vocabulary", Kind::vocabulary, vocabulary,
                       "vocabulary (.vocabulary.json, .ttl, .rdf) that tags and attributes must be from");
        words.describe(p.options);
        p.input_option("rules", Kind::rules, rules, "rules of the class (.rules.json) that the annotations must satisfy");
        p.input_option("graph", Kind::graph, graph,
                       "relationships that the rules refer to (.graph.json); without it containment and adjacency are computed "
                       "from the mesh");
        p.report.checks = true;
    }

    void check() const override {
        if (graph && !rules) fail_usage("--graph goes with --rules", "add --rules FILE");
    }

    void run(Context&, Report& report) override {
        // An unreadable file is a failure, not a "no".
        const Vocabulary* known_words = vocabulary ? &vocabulary.load<Vocabulary>(read_vocabulary) : nullptr;
        const ClassRules* kept_rules = rules ? &rules.load<ClassRules>(read_class_rules) : nullptr;
        const Mesh& on = mesh->mesh;
        const auto given = annotations.sources.front().object.as<AnnotationSet>();
        const Json* document = given ? nullptr : &annotations.load<Json>(read_json);
        std::vector<Finding> findings;
        std::optional<AnnotationSet> set;
        try {
            if (given) check_annotations(*given, on, annotations.file());
            set = given ? *annotations.annotations_on(on) : annotations_from_json(*document, on, annotations.file(), reading);
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::input) throw;
            findings.push_back({true, "", error.problem() + (error.remedy().empty() ? "" : " (" + error.remedy() + ")")});
        }
        if (set) {
            for (const auto& note : set->notes) findings.push_back({false, "", note});
            const auto add = [&](std::vector<Finding> more) { findings.insert(findings.end(), more.begin(), more.end()); };
            add(examine(on, *set));
            if (!given) add(check_files(*set, on, Path(annotations.file()).parent_path()));
            if (known_words != nullptr) add(check_against_vocabulary(*set, *known_words, words));
            if (known_words != nullptr) add(check_parts(on, *set, *known_words));
            if (kept_rules != nullptr) hold_against(*kept_rules, known_words, on, *set, findings);
        }
        report.findings(findings);
    }

    void hold_against(const ClassRules& kept, const Vocabulary* known, const Mesh& on, const AnnotationSet& set,
                      std::vector<Finding>& findings) const {
        const RelationGraph* stated = graph ? &graph.on(set) : nullptr;
        for (const BrokenRule& broken : broken_rules(on, set, kept, known, stated, rules.file())) {
            std::string where;
            for (std::size_t i = 0; i < set.annotations.size(); ++i)
                if (broken.annotation == set.annotations[i].id) where = "/annotations/" + std::to_string(i);
            findings.push_back({true, where, "rule '" + broken.rule + "': " + broken.text});
        }
    }

    MeshInput mesh;
    FileInput annotations, vocabulary, rules;
    GraphInput graph;
    ReadAnnotationsOptions reading;
    CheckVocabularyOptions words;
};

}  // namespace

std::unique_ptr<Operation> make_annotation_check() { return make<AnnotationCheck>(); }

}  // namespace ostraka
