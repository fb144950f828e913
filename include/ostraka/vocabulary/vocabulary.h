// Controlled vocabularies: the concepts that tags name, and the attributes that each may have (thesis, sections 2.2.1 and
// 2.2.3).
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/finding.h"
#include "ostraka/core/options.h"
#include "ostraka/files/file.h"

#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace ostraka {

/// Text by language ("en", "it", "de-AT"); the key "" holds text without a language.
using Labels = std::map<std::string, std::string>;

/// An allowed value of a qualitative attribute.
struct Term {
    std::string name;  ///< as stored in annotation files; labels are accepted as well
    Labels labels;
};

/// An attribute that annotations of a concept may have.
struct AllowedAttribute {
    std::string name;
    Labels labels;
    Labels definition;
    std::vector<Term> values;        ///< allowed values of a qualitative attribute; empty: any text
    std::optional<double> min, max;  ///< range of a quantitative attribute, in `unit`
    std::string unit;

    /// True if a range or a unit declares a quantity.
    [[nodiscard]] bool quantitative() const { return min || max || !unit.empty(); }
};

/// A statement of a SKOS file that is kept but not used: skos:related, skos:exactMatch, dcterms:source ...
struct ForeignStatement {
    std::string property;  ///< URI of the property
    std::string value;     ///< text or URI
    bool is_uri = false;
    std::string language, datatype;  ///< language or type of a text; at most one of the two is set
    auto operator<=>(const ForeignStatement&) const = default;
};

struct Concept {
    std::string id;
    std::string uri;  ///< empty if it is the vocabulary's URI followed by the id
    Labels labels;
    std::map<std::string, std::vector<std::string>> alternatives;  ///< alternative labels by language
    std::vector<std::string> broader;                              ///< ids of broader concepts
    std::vector<std::string> part_of;                              ///< ids of concepts of which this one is a part
    Labels definition;
    std::vector<AllowedAttribute> attributes;
    std::vector<ForeignStatement> others;
};

/// An operand of a condition: an attribute of the annotation itself, or of the only annotation of another concept.
struct Operand {
    std::string attribute;
    std::string concept_id;  ///< empty: the annotation that the rule is applied to
    auto operator<=>(const Operand&) const = default;
};

/// A condition of a rule: a number (an attribute, or the ratio of two) within bounds, or a word from a list.
struct Condition {
    Operand operand;
    std::optional<Operand> divisor;
    std::optional<double> min, max;      ///< inclusive bounds
    std::optional<double> above, below;  ///< exclusive bounds
    std::string unit;                    ///< unit of the bounds; empty: that of the attribute
    std::vector<std::string> is;         ///< accepted values of a qualitative attribute
};

/// Infers a qualitative attribute of annotations of a concept if all conditions hold (thesis, section 2.2.3).
struct InferenceRule {
    std::string id;
    std::string note;
    std::string concept_id;  ///< includes narrower concepts; empty: any annotation
    std::vector<Condition> conditions;
    std::string attribute, value;
};

struct Vocabulary {
    std::string uri;
    Labels title;
    std::vector<AllowedAttribute> attributes;  ///< attributes that every concept may have
    std::vector<Concept> concepts;
    std::vector<InferenceRule> rules;
    std::vector<ForeignStatement> others;
    std::vector<std::string> notes;  ///< notes from reading; not written
};

/// Reads *.vocabulary.json (doc/vocabularies.md). Throws Error (input) that names the file, the JSON pointer and the remedy: a
/// file that does not match its schema, duplicate concept ids, a missing broader concept, a cycle of broader concepts, a
/// duplicate attribute, a range with min above max, a rule that refers to something not in the vocabulary.
Vocabulary read_vocabulary(const Path& file);
Vocabulary vocabulary_from_json(const JsonValue& document, const std::string& where);
Json vocabulary_to_json(const Vocabulary& vocabulary);
/// Checks as reading does, then writes. Reading and writing again gives the same bytes.
void write_vocabulary(const Path& file, const Vocabulary& vocabulary);
/// Performs the checks of reading on a vocabulary in memory. Linear in its size.
void check_vocabulary(const Vocabulary& vocabulary, const std::string& where);

/// Reports what is allowed in a vocabulary but may be unintended: concepts without labels or with labels shared by others,
/// languages in which only some concepts have labels, rules that contradict each other if both apply.
std::vector<Finding> examine(const Vocabulary& vocabulary);

/// Queries on a vocabulary, which must have passed check_vocabulary and must outlive this object. Construction is linear. Not
/// thread-safe: attribute names of queried concepts are cached.
class VocabularySearch {
public:
    explicit VocabularySearch(const Vocabulary& vocabulary);

    /// Indices of the concepts that a tag may mean: the concept whose id equals the tag exactly; otherwise those that have it
    /// as a label in any language, ignoring case and blanks; otherwise the same without a number at the end ("flower 3" means
    /// "flower"). Several if the tag is ambiguous, none if it is unknown.
    [[nodiscard]] std::vector<std::size_t> concepts_of(const std::string& tag) const;
    /// The concept of a tag; nothing if the tag is unknown or ambiguous.
    [[nodiscard]] std::optional<std::size_t> concept_of(const std::string& tag) const;
    /// The index of the concept with this id.
    [[nodiscard]] std::optional<std::size_t> find(const std::string& id) const;
    /// True if the concept is the other one or narrower.
    [[nodiscard]] bool is_a(std::size_t concept_index, std::size_t other) const;
    /// The concept and all broader ones, nearest first.
    [[nodiscard]] std::vector<std::size_t> lineage(std::size_t concept_index) const;
    /// The concepts that this one is a part of, as stated by it or by a broader concept, followed by the wholes of those; one
    /// list per level, nearest first.
    [[nodiscard]] std::vector<std::vector<std::size_t>> containing_concepts(std::size_t concept_index) const;
    /// The attributes that the concept may have: its own, those of broader concepts, and those of every concept; of equal names
    /// the nearer wins.
    [[nodiscard]] std::vector<const AllowedAttribute*> attributes_of(std::size_t concept_index) const;
    /// The allowed attribute with this name or label, or nullptr.
    [[nodiscard]] const AllowedAttribute* attribute_of(std::size_t concept_index, const std::string& name) const;
    /// The attribute of that name among those that every concept may have, or nullptr.
    [[nodiscard]] const AllowedAttribute* common_attribute(const std::string& name) const;
    /// Ids and labels with similar spelling, closest first.
    [[nodiscard]] std::vector<std::string> suggestions(const std::string& tag) const;
    /// The concept's label in this language, else without a language, else in English, else in any; the id if it has no label.
    [[nodiscard]] std::string label(std::size_t concept_index, const std::string& language) const;

    [[nodiscard]] const Vocabulary& vocabulary() const { return vocabulary_; }

private:
    const Vocabulary& vocabulary_;
    std::unordered_map<std::string, std::size_t> ids_;
    std::unordered_map<std::string, std::vector<std::size_t>> labels_;  ///< folded text -> concepts
    std::unordered_map<std::string, const AllowedAttribute*> common_;   ///< by folded name, the attributes that every concept
                                                                        ///< may have
    /// For each concept, its attributes by folded names and labels.
    mutable std::unordered_map<std::size_t, std::unordered_map<std::string, const AllowedAttribute*>> attributes_;
    std::vector<std::vector<std::size_t>> broader_, part_of_;
};

/// The allowed value that a text means, by name or label; nullptr if none.
const Term* term_of(const AllowedAttribute& attribute, const std::string& text);

struct CheckVocabularyOptions {
    bool strict = false;  ///< treat quantities that are not in the vocabulary as defects

    void list_options(OptionList& list);
};

/// Checks the tags and attributes of a set. Defects: a tag that no concept has or that several have, a qualitative attribute
/// that the concept may not have, a value outside its list, a word instead of a number or a number instead of a word, a
/// quantity outside its range or in a unit that cannot be converted. Suggests similar names. Remarks: quantities that are not
/// in the vocabulary (defects if `strict`), stale quantities, and quantities without a unit, whose range was not checked.
std::vector<Finding> check_against_vocabulary(const AnnotationSet& set, const Vocabulary& vocabulary,
                                              const CheckVocabularyOptions& options = {});
/// Throws Error (input) with the first defect, if any; `where` names the file of the set.
void require_vocabulary(const AnnotationSet& set, const Vocabulary& vocabulary, const std::string& where,
                        const CheckVocabularyOptions& options = {});

}  // namespace ostraka
