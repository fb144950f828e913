#include "word_checks.h"

#include "ostraka/relation/topology.h"

namespace ostraka::app {

void WordChecks::add_to(CLI::App& command, bool with_rules) {
    command.add_option("--vocabulary", vocabulary,
                       "vocabulary (.vocabulary.json, .ttl, .rdf) that tags and attributes must be from");
    add_flags(&command, options);
    if (!with_rules) return;
    command.add_option("--rules", rules, "rules of the class (.rules.json) that the annotations must keep");
    command.add_option(
        "--graph", graph,
        "relationships that the rules speak of (.graph.json); without it containment and adjacency are taken from the mesh");
}

std::vector<Path> WordChecks::files() const {
    std::vector<Path> list;
    for (const std::string& file : {vocabulary, rules, graph})
        if (!file.empty()) list.emplace_back(file);
    return list;
}

void WordChecks::read(Provenance& provenance) {
    if (!graph.empty() && rules.empty()) fail_usage("--graph goes with --rules", "add --rules FILE");
    for (const Path& file : files()) provenance.add_input(file);
    if (!vocabulary.empty()) {
        words_ = read_vocabulary(vocabulary);
        for (const auto& option : list_options(options)) provenance.options.push_back(option);
    }
    if (!rules.empty()) rules_ = read_class_rules(rules);
}

void WordChecks::look(const Mesh& mesh, const AnnotationSet& set, std::vector<Finding>& findings) const {
    if (words_)
        for (auto& finding : check_against_vocabulary(set, *words_, options))
            findings.push_back({finding.defect, std::move(finding.where), std::move(finding.text)});
    if (!rules_) return;
    std::vector<Relationship> relationships;
    if (!graph.empty()) relationships = read_graph(graph, set).relationships;
    else if (rules_->about_relations()) relationships = relationships_of(topology(mesh, set), set, 0);
    std::vector<RelationFact> facts;
    for (const Relationship& relationship : relationships)
        facts.push_back({relationship.type, relationship.directed, relationship.annotations});
    for (const BrokenRule& broken : check_class_rules(set, *rules_, words_ ? &*words_ : nullptr, facts, rules)) {
        std::string where;
        for (std::size_t i = 0; i < set.annotations.size(); ++i)
            if (broken.annotation == set.annotations[i].id) where = "/annotations/" + std::to_string(i);
        findings.push_back({true, where, "rule '" + broken.rule + "': " + broken.text});
    }
}

void WordChecks::require(const AnnotationSet& set, const std::string& where) const {
    if (words_) require_vocabulary(set, *words_, where, options);
}

}  // namespace ostraka::app
