// annotation check
#include "operations/operations.h"

#include "ostraka/measure/examine.h"
#include "ostraka/relation/part_of.h"
#include "ostraka/relation/rules.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

struct AnnotationCheck final : Operation {
    void declare(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file");
        p.input("annotations", Kind::annotations, annotations, "annotations of the mesh (.ant.json)");
        reading.declare_options(p.options);
        p.input_option("vocabulary", Kind::vocabulary, vocabulary,
                       "vocabulary (.vocabulary.json, .ttl, .rdf) in which all tags and attributes must be defined");
        words.declare_options(p.options);
        p.input_option("rules", Kind::rules, rules, "rules of the class (.rules.json) that the annotations must satisfy");
        p.input_option("graph", Kind::graph, graph,
                       "relationships to which the rules refer (.graph.json); if left out, containment and adjacency are "
                       "computed from the mesh");
        p.report.checks = true;
    }

    void check() const override {
        if (graph && !rules) fail_usage("--graph needs --rules", "add --rules FILE");
    }

    void run(Context&, Report& report) override {
        // An unreadable file is a failure, not a "no".
        const Vocabulary* vocabulary_words = vocabulary ? &vocabulary.load<Vocabulary>(read_vocabulary) : nullptr;
        const ClassRules* class_rules = rules ? &rules.load<ClassRules>(read_class_rules) : nullptr;
        const Mesh& surface = mesh->mesh;
        const auto in_memory = annotations.sources.front().object.as<AnnotationSet>();
        const Json* document = in_memory ? nullptr : &annotations.load<Json>(read_json);
        std::vector<Finding> findings;
        std::optional<AnnotationSet> set;
        try {
            if (in_memory) check_annotations({surface, *in_memory}, annotations.file());
            set = in_memory ? *annotations.annotations_on(surface)
                            : annotations_from_json(*document, surface, annotations.file(), reading);
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::input) throw;
            findings.push_back(
                {true, "", error.remedy().empty() ? error.problem() : fmt::format("{} ({})", error.problem(), error.remedy())});
        }
        if (set) {
            for (const auto& note : set->notes) findings.push_back({false, "", note});
            const auto append = [&](std::vector<Finding> further) {
                findings.insert(findings.end(), further.begin(), further.end());
            };
            append(examine({surface, *set}));
            if (!in_memory) append(check_files({surface, *set}, Path(annotations.file()).parent_path()));
            if (vocabulary_words != nullptr) append(check_against_vocabulary(*set, *vocabulary_words, words));
            if (vocabulary_words != nullptr) append(check_parts({surface, *set}, *vocabulary_words));
            if (class_rules != nullptr) check_rules(*class_rules, vocabulary_words, {surface, *set}, findings);
        }
        report.findings(findings);
    }

    void check_rules(const ClassRules& class_rules, const Vocabulary* vocabulary_words, AnnotatedMeshView object,
                     std::vector<Finding>& findings) const {
        const RelationGraph* relationships = graph ? &graph.on(object.annotations) : nullptr;
        for (const RuleViolation& broken : broken_rules(object, class_rules, vocabulary_words, relationships, rules.file())) {
            std::string where;
            for (std::size_t i = 0; i < object.annotations.annotations.size(); ++i)
                if (broken.annotation == object.annotations.annotations[i].id) where = "/annotations/" + std::to_string(i);
            findings.push_back({true, where, fmt::format("rule '{}': {}", broken.rule, broken.text)});
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
