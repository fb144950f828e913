// Annotations held against a vocabulary and against the rules of a class.
#pragma once

#include "command.h"

#include "ostraka/measure/examine.h"
#include "ostraka/vocabulary/class_rules.h"

namespace ostraka::app {

struct WordChecks {
    std::string vocabulary, rules, graph;
    CheckVocabularyOptions options;

    /// `with_rules`: --rules and --graph too.
    void add_to(CLI::App& command, bool with_rules);
    /// The files given.
    [[nodiscard]] std::vector<Path> files() const;
    /// To be called before the work: a vocabulary or rules that cannot be read are a failure, not an answer.
    void read(Provenance& provenance);
    /// What does not fit, behind what was found already.
    void look(const Mesh& mesh, const AnnotationSet& set, std::vector<Finding>& findings) const;
    /// Throws Error (input) if anything does not fit the vocabulary; `where` names what the set came from.
    void require(const AnnotationSet& set, const std::string& where) const;

private:
    std::optional<Vocabulary> words_;
    std::optional<ClassRules> rules_;
};

}  // namespace ostraka::app
