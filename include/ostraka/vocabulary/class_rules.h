// Rules about the annotations of a class of objects: "exactly two eyes", "the nose is adjacent to the face", "every region has
// a material" (doc/vocabularies.md).
#pragma once

#include "ostraka/vocabulary/vocabulary.h"

namespace ostraka {

/// The annotations that a rule applies to.
struct Subject {
    std::string tag;  ///< includes narrower concepts if there is a vocabulary; "*" for any
    std::optional<AnnotationType> type;
};

struct CountRule {
    Subject subject;
    std::optional<int> min, max;
};

struct AttributeRule {
    Subject subject;
    std::string name;
    std::vector<std::string> values;  ///< allowed values of a qualitative attribute; empty: any
    std::optional<double> min, max;   ///< range of a quantitative attribute, in `unit`
    std::string unit;
};

struct RelationRule {
    Subject subject;
    std::vector<std::string> types;  ///< any of these types of relationship satisfies the rule
    Subject to;
    enum class Place { any, first, second } place = Place::any;  ///< position of the subject in a directed relationship
};

/// A rule of one of the three kinds.
struct ClassRule {
    std::string id, note;
    std::optional<CountRule> count;
    std::optional<AttributeRule> attribute;
    std::optional<RelationRule> relation;
};

struct ClassRules {
    std::string object_class;
    std::vector<ClassRule> rules;
    /// True if any rule is about relationships.
    [[nodiscard]] bool uses_relations() const;
};

/// Reads *.rules.json. Throws Error (input) that names the file, the JSON pointer and the remedy.
ClassRules read_class_rules(const Path& file);
ClassRules class_rules_from_json(const JsonValue& document, const std::string& where);

/// A relationship as input of the rules. Types are compared ignoring case; "containment" is [container, contained] and treated
/// as transitive.
struct RelationFact {
    std::string type;
    bool directed = false;
    std::vector<int> annotations;
};

/// A violated rule, with a text that explains the violation.
struct RuleViolation {
    std::string rule;
    std::optional<int> annotation;  ///< the annotation that violates it, if it is a single one
    std::string text;
};

/// Every violated rule; a rule that applies to each annotation is listed once for each that violates it. Tags and words are
/// compared by the vocabulary (labels in any language, narrower concepts), without a vocabulary by their letters. Throws Error
/// (input) if a rule names a tag that is not in the vocabulary; `where` names the file of the rules.
std::vector<RuleViolation> check_class_rules(const AnnotationSet& set, const ClassRules& rules, const Vocabulary* vocabulary,
                                             const std::vector<RelationFact>& relations, const std::string& where);

}  // namespace ostraka
