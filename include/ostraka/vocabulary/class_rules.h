// What annotations of a class of objects must have: "exactly two eyes", "the nose is adjacent to the face", "every region has a
// material" (doc/vocabularies.md).
#pragma once

#include "ostraka/vocabulary/vocabulary.h"

namespace ostraka {

/// Which annotations a rule is about.
struct Subject {
    std::string tag;  ///< with narrower concepts where there is a vocabulary; "*" for any
    std::optional<AnnotationType> type;
};

struct CountRule {
    Subject subject;
    std::optional<int> min, max;
};

struct AttributeRule {
    Subject subject;
    std::string name;
    std::vector<std::string> values;  ///< of a qualitative attribute; empty: any
    std::optional<double> min, max;   ///< of a quantitative one, in `unit`
    std::string unit;
};

struct RelationRule {
    Subject subject;
    std::vector<std::string> types;  ///< any of these types of relationship will do
    Subject to;
    enum class Place { any, first, second } place = Place::any;  ///< of the subject in a relationship that is directed
};

/// A rule is of one of the three kinds.
struct ClassRule {
    std::string id, note;
    std::optional<CountRule> count;
    std::optional<AttributeRule> attribute;
    std::optional<RelationRule> relation;
};

struct ClassRules {
    std::string object_class;
    std::vector<ClassRule> rules;
    /// Is any rule about relationships?
    [[nodiscard]] bool about_relations() const;
};

/// Reads *.rules.json. Throws Error (input) that names the file, the JSON pointer and the remedy.
ClassRules read_class_rules(const Path& file);
ClassRules class_rules_from_json(const JsonValue& document, const std::string& where);

/// A relationship as rules see it. Types are compared without regard to case; "containment" is [container, contained] and taken
/// to be transitive.
struct RelationFact {
    std::string type;
    bool directed = false;
    std::vector<int> annotations;
};

/// A rule that is not kept, in words.
struct BrokenRule {
    std::string rule;
    std::optional<int> annotation;  ///< the annotation that breaks it, where it is one
    std::string text;
};

/// Every rule that is broken; where annotations each have to keep it, once for each that does not. Tags and words are compared by
/// the vocabulary (labels in any language, narrower concepts), without one by their letters. Throws Error (input) if a rule names
/// a tag that the vocabulary does not have; `where` names the file of the rules.
std::vector<BrokenRule> check_class_rules(const AnnotationSet& set, const ClassRules& rules, const Vocabulary* vocabulary,
                                          const std::vector<RelationFact>& relations, const std::string& where);

}  // namespace ostraka
