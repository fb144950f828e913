// Controlled vocabularies: the concepts that tags name, and the attributes that annotations of each concept may have (thesis,
// sections 2.2.1 and 2.2.3).
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

/// Texts by language ("en", "it", "de-AT"); the key "" holds a text without a language.
using Labels = std::map<std::string, std::string>;

/// An allowed value of a qualitative attribute.
struct Term {
    std::string name;  ///< value as stored in annotation files; labels are accepted as well
    Labels labels;     ///< names in several languages
};

/// An attribute that annotations of a concept may have.
struct AllowedAttribute {
    std::string name;                ///< name of the attribute
    Labels labels;                   ///< names in several languages
    Labels definition;               ///< definition in several languages
    std::vector<Term> values;        ///< allowed values of a qualitative attribute; empty: any text
    std::optional<double> min, max;  ///< range of a quantitative attribute, in `unit`
    std::string unit;                ///< unit of the range

    /// True if the attribute is a quantity, which a range or a unit declares.
    [[nodiscard]] bool quantitative() const { return min || max || !unit.empty(); }
};

/// A statement of a SKOS file that is kept but not interpreted: skos:related, skos:exactMatch, dcterms:source ...
struct ForeignStatement {
    std::string property;            ///< URI of the property
    std::string value;               ///< text or URI
    bool is_uri = false;             ///< true: the value is a URI
    std::string language, datatype;  ///< language or data type of a text; at most one is set
    auto operator<=>(const ForeignStatement&) const = default;
};

/// A concept that a tag may name.
struct Concept {
    std::string id;   ///< id of the concept within the vocabulary
    std::string uri;  ///< URI of the concept; empty: the vocabulary's URI followed by the id
    Labels labels;    ///< names in several languages
    std::map<std::string, std::vector<std::string>> alternatives;  ///< alternative labels by language
    std::vector<std::string> broader;                              ///< ids of the broader concepts
    std::vector<std::string> part_of;                              ///< ids of the concepts of which this concept is a part
    Labels definition;                                             ///< definition in several languages
    std::vector<AllowedAttribute> attributes;                      ///< attributes that annotations of the concept may have
    std::vector<ForeignStatement> others;                          ///< statements that are not interpreted
};

/// An operand of a condition: an attribute of the annotation itself, or of the only annotation of another concept.
struct Operand {
    std::string attribute;   ///< name of the attribute
    std::string concept_id;  ///< id of the other concept; empty: the annotation to which the rule is applied
    auto operator<=>(const Operand&) const = default;
};

/// A condition of a rule: a number (an attribute, or the ratio of two attributes) is within bounds, or a qualitative attribute
/// has one of the listed values.
struct Condition {
    Operand operand;                     ///< attribute that is tested, or numerator of the ratio
    std::optional<Operand> divisor;      ///< denominator of the ratio; empty: no ratio
    std::optional<double> min, max;      ///< inclusive bounds
    std::optional<double> above, below;  ///< exclusive bounds
    std::string unit;                    ///< unit of the bounds; empty: the unit of the attribute
    std::vector<std::string> is;         ///< accepted values of a qualitative attribute; empty: the condition is on a number
};

/// A rule that infers a qualitative attribute of annotations of a concept if all conditions hold (thesis, section 2.2.3).
struct InferenceRule {
    std::string id;                     ///< id of the rule
    std::string note;                   ///< comment on the rule
    std::string concept_id;             ///< concept of the annotations, including narrower concepts; empty: any annotation
    std::vector<Condition> conditions;  ///< conditions, all of which must hold
    std::string attribute, value;       ///< name and value of the inferred attribute
};

/// A controlled vocabulary.
struct Vocabulary {
    std::string uri;                           ///< URI of the vocabulary; empty: none
    Labels title;                              ///< title in several languages
    std::vector<AllowedAttribute> attributes;  ///< attributes that every concept may have
    std::vector<Concept> concepts;             ///< the concepts
    std::vector<InferenceRule> rules;          ///< rules that infer attributes
    std::vector<ForeignStatement> others;      ///< statements that are not interpreted
    std::vector<std::string> notes;            ///< messages about reading a file; not written to files
};

/// Reads a vocabulary file (*.vocabulary.json; doc/vocabularies.md). Throws Error (input) that names the file, the JSON pointer
/// and the remedy, for a file that does not match its schema, duplicate concept ids, a missing broader concept, a cycle of
/// broader concepts, a duplicate attribute, a range with min above max, a rule that refers to a concept, attribute or value
/// that is not in the vocabulary.
Vocabulary read_vocabulary(const Path& file);
/// Reads a vocabulary from JSON, with the checks of read_vocabulary.
Vocabulary vocabulary_from_json(const JsonValue& document, const std::string& where);
Json vocabulary_to_json(const Vocabulary& vocabulary);  ///< the vocabulary as a JSON document
/// Writes a vocabulary after the checks that `read_vocabulary` performs. Reading and writing again gives the same bytes.
void write_vocabulary(const Path& file, const Vocabulary& vocabulary);
/// Performs the checks of `read_vocabulary` on a vocabulary in memory; `where` names the vocabulary in errors. Time: linear in
/// the size of the vocabulary.
void check_vocabulary(const Vocabulary& vocabulary, const std::string& where);

/// Reports properties of a vocabulary that are allowed but may be unintended: concepts without labels or with labels shared by
/// other concepts, languages in which only some concepts have labels, rules that contradict each other if both apply.
std::vector<Finding> examine(const Vocabulary& vocabulary);

/// Queries on a vocabulary, which must have passed check_vocabulary and must outlive this object. Construction takes linear
/// time. The object is not thread-safe, because it caches attribute names of queried concepts.
class VocabularySearch {
public:
    explicit VocabularySearch(const Vocabulary& vocabulary);

    /// Indices of the concepts that a tag may mean: the concept whose id equals the tag exactly; otherwise the concepts that have
    /// the tag as a label in any language, ignoring case and blanks; otherwise the concepts of the tag without a number at its
    /// end ("flower 3" means "flower"). Several concepts if the tag is ambiguous, none if the tag is unknown.
    [[nodiscard]] std::vector<std::size_t> concepts_of(const std::string& tag) const;
    /// The concept of a tag; nothing if the tag is unknown or ambiguous.
    [[nodiscard]] std::optional<std::size_t> concept_of(const std::string& tag) const;
    /// The index of the concept with this id; empty: there is none.
    [[nodiscard]] std::optional<std::size_t> find(const std::string& id) const;
    /// True if the concept is the concept `other` or a narrower one.
    [[nodiscard]] bool is_a(std::size_t concept_index, std::size_t other) const;
    /// Indices of the concept and of all broader concepts, nearest first.
    [[nodiscard]] std::vector<std::size_t> lineage(std::size_t concept_index) const;
    /// Indices of the concepts of which this concept is a part, directly or indirectly; one list per level, nearest first. The
    /// first level are the concepts stated by this concept or by a broader concept.
    [[nodiscard]] std::vector<std::vector<std::size_t>> containing_concepts(std::size_t concept_index) const;
    /// The attributes that annotations of the concept may have: attributes of the concept, of broader concepts, and of every
    /// concept; among equal names the attribute of the nearer concept is used.
    [[nodiscard]] std::vector<const AllowedAttribute*> attributes_of(std::size_t concept_index) const;
    /// The attribute of a concept with this name or label, or nullptr.
    [[nodiscard]] const AllowedAttribute* attribute_of(std::size_t concept_index, const std::string& name) const;
    /// The attribute with this name among the attributes that every concept may have, or nullptr.
    [[nodiscard]] const AllowedAttribute* common_attribute(const std::string& name) const;
    /// Ids and labels with a spelling similar to the tag, closest first.
    [[nodiscard]] std::vector<std::string> suggestions(const std::string& tag) const;
    /// The concept's label in this language, else without a language, else in English, else in any language; the id if there is
    /// no label.
    [[nodiscard]] std::string label(std::size_t concept_index, const std::string& language) const;

    [[nodiscard]] const Vocabulary& vocabulary() const { return vocabulary_; }

private:
    const Vocabulary& vocabulary_;
    std::unordered_map<std::string, std::size_t> ids_;  ///< from the id of a concept to its index
    /// From a label in normal form to the indices of the concepts that have it.
    std::unordered_map<std::string, std::vector<std::size_t>> labels_;
    /// From a name in normal form to the attribute that every concept may have.
    std::unordered_map<std::string, const AllowedAttribute*> common_;
    /// From the index of a concept to its attributes by names and labels in normal form.
    mutable std::unordered_map<std::size_t, std::unordered_map<std::string, const AllowedAttribute*>> attributes_;
    /// For each concept, the indices of its broader concepts, and of the concepts of which it is a part.
    std::vector<std::vector<std::size_t>> broader_, part_of_;
};

/// The allowed value of an attribute with this name or label; nullptr if there is none.
const Term* term_of(const AllowedAttribute& attribute, const std::string& text);

struct CheckVocabularyOptions {
    bool strict = false;  ///< true: quantities that are not in the vocabulary are defects

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Checks the tags and attributes of annotations. Defects: a tag that names no concept or several concepts, a qualitative
/// attribute that the vocabulary does not allow for the concept, a value outside the attribute's list, a word instead of a
/// number or a number instead of a word, a quantity outside its range or in a unit that cannot be converted. Suggests similar
/// names. Remarks: quantities that are not in the vocabulary (defects if `strict`), stale quantities, and quantities without a
/// unit, whose range was not checked.
std::vector<Finding> check_against_vocabulary(const AnnotationSet& set, const Vocabulary& vocabulary,
                                              const CheckVocabularyOptions& options = {});
/// Throws Error (input) with the first defect that `check_against_vocabulary` finds; `where` names the file of the annotations.
void require_vocabulary(const AnnotationSet& set, const Vocabulary& vocabulary, const std::string& where,
                        const CheckVocabularyOptions& options = {});

}  // namespace ostraka
