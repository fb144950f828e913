// Rules for the annotations of a class of objects: "exactly two eyes", "the nose is adjacent to the face", "every region has a
// material" (doc/vocabularies.md).
#pragma once

#include "ostraka/vocabulary/vocabulary.h"

namespace ostraka {

/// The annotations to which a rule applies.
struct Subject {
    std::string tag;  ///< tag of the annotations, including narrower concepts if there is a vocabulary; "*": any tag
    std::optional<AnnotationType> type;  ///< type of the annotations; empty: any type
};

/// Requires a number of annotations.
struct CountRule {
    Subject subject;              ///< the annotations that are counted
    std::optional<int> min, max;  ///< min and max number of annotations; empty: no bound
};

/// Requires an attribute of every annotation.
struct AttributeRule {
    Subject subject;                  ///< the annotations that must have the attribute
    std::string name;                 ///< name of the attribute
    std::vector<std::string> values;  ///< allowed values of a qualitative attribute; empty: any value
    std::optional<double> min, max;   ///< range of a quantitative attribute, in `unit`
    std::string unit;                 ///< unit of the range
};

/// Requires a relationship of every annotation.
struct RelationRule {
    Subject subject;                                             ///< the annotations that must have the relationship
    std::vector<std::string> types;                              ///< types of relationship, any of which satisfies the rule
    Subject to;                                                  ///< the annotations with which the relationship is required
    enum class Place { any, first, second } place = Place::any;  ///< position of the subject in a directed relationship
};

/// A rule of one of the three kinds; the other two kinds are empty.
struct ClassRule {
    std::string id, note;  ///< id of the rule, and a comment
    std::optional<CountRule> count;
    std::optional<AttributeRule> attribute;
    std::optional<RelationRule> relation;
};

/// Rules of a class of objects.
struct ClassRules {
    std::string object_class;      ///< name of the class
    std::vector<ClassRule> rules;  ///< the rules
    /// True if at least one rule concerns relationships.
    [[nodiscard]] bool uses_relations() const;
};

/// Reads a rules file (*.rules.json). Throws Error (input) that names the file, the JSON pointer and the remedy.
ClassRules read_class_rules(const Path& file);
/// Reads rules from JSON, with the checks of read_class_rules.
ClassRules class_rules_from_json(const JsonValue& document, const std::string& where);

/// A relationship between annotations, to which rules are applied. Types are compared ignoring case; "containment" is [container,
/// contained] and treated as transitive.
struct RelationFact {
    std::string type;              ///< type of the relationship
    bool directed = false;         ///< true: the first annotation is the subject
    std::vector<int> annotations;  ///< ids of the annotations
};

/// A violated rule, with a text that explains the violation.
struct RuleViolation {
    std::string rule;  ///< id of the rule
    /// Id of the annotation that violates the rule; empty: the violation concerns no single annotation.
    std::optional<int> annotation;
    std::string text;  ///< explanation of the violation
};

/// Returns all violations of the rules. A rule that applies to each annotation is listed once for each annotation that violates
/// it. Tags and words are compared by the vocabulary (labels in any language, narrower concepts), or without a vocabulary by
/// spelling. Throws Error (input) if a rule names a tag that is not in the vocabulary; `where` names the file of the rules.
std::vector<RuleViolation> check_class_rules(const AnnotationSet& set, const ClassRules& rules, const Vocabulary* vocabulary,
                                             const std::vector<RelationFact>& relations, const std::string& where);

}  // namespace ostraka
