// Controlled vocabularies: the concepts that tags name, and the attributes each may carry (thesis, sections 2.2.1 and 2.2.3).
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/file.h"
#include "ostraka/core/finding.h"
#include "ostraka/core/options.h"

#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace ostraka {

/// Text by language ("en", "it", "de-AT"); the key "" holds text of no stated language.
using Labels = std::map<std::string, std::string>;

/// A word a qualitative attribute may have as its value.
struct Term {
    std::string name;  ///< what annotation files hold; its labels are read as well
    Labels labels;
};

/// An attribute that annotations of a concept may carry.
struct AllowedAttribute {
    std::string name;
    Labels labels;
    Labels definition;
    std::vector<Term> values;        ///< of a qualitative attribute; empty: any text
    std::optional<double> min, max;  ///< of a quantitative attribute, in `unit`
    std::string unit;

    /// Stated to be a quantity, by a range or a unit.
    [[nodiscard]] bool quantitative() const { return min || max || !unit.empty(); }
};

/// A statement of a SKOS file that we keep but do not use: skos:related, skos:exactMatch, dcterms:source ...
struct ForeignStatement {
    std::string property;  ///< URI
    std::string value;     ///< text or URI
    bool is_uri = false;
    std::string language, datatype;  ///< of a text; at most one of the two
    auto operator<=>(const ForeignStatement&) const = default;
};

struct Concept {
    std::string id;
    std::string uri;  ///< empty where it is the vocabulary's with the id behind it
    Labels labels;
    std::map<std::string, std::vector<std::string>> alternatives;  ///< further labels by language
    std::vector<std::string> broader;                              ///< ids
    std::vector<std::string> part_of;                              ///< ids of concepts that it is a part of
    Labels definition;
    std::vector<AllowedAttribute> attributes;
    std::vector<ForeignStatement> others;
};

/// A side of a comparison in a rule: an attribute of the annotation itself, or of the only annotation of another concept.
struct Operand {
    std::string attribute;
    std::string concept_id;  ///< empty: the annotation the rule looks at
    auto operator<=>(const Operand&) const = default;
};

/// One condition of a rule: a number (an attribute, or the ratio of two) within bounds, or a word that is one of several.
struct Condition {
    Operand operand;
    std::optional<Operand> divisor;
    std::optional<double> min, max;      ///< bounds that belong to the range
    std::optional<double> above, below;  ///< bounds that do not
    std::string unit;                    ///< of the bounds; empty: as the attribute has it
    std::vector<std::string> is;         ///< of a qualitative attribute
};

/// Infers a qualitative attribute of annotations of a concept where all conditions hold (thesis, section 2.2.3).
struct InferenceRule {
    std::string id;
    std::string note;
    std::string concept_id;  ///< with its narrower ones; empty: any annotation
    std::vector<Condition> conditions;
    std::string attribute, value;
};

struct Vocabulary {
    std::string uri;
    Labels title;
    std::vector<AllowedAttribute> attributes;  ///< that every concept may carry
    std::vector<Concept> concepts;
    std::vector<InferenceRule> rules;
    std::vector<ForeignStatement> others;
    std::vector<std::string> notes;  ///< what reading had to say; not written
};

/// Reads *.vocabulary.json (doc/vocabularies.md). Throws Error (input) that names the file, the JSON pointer and the remedy: a
/// file that does not fit its schema, two concepts with one id, a broader concept that is missing, a cycle of broader concepts,
/// an attribute named twice, a range upside down, a rule that speaks of what the vocabulary does not have.
Vocabulary read_vocabulary(const Path& file);
Vocabulary vocabulary_from_json(const JsonValue& document, const std::string& where);
Json vocabulary_to_json(const Vocabulary& vocabulary);
/// Checks as reading does, then writes. Reading and writing again gives the same bytes.
void write_vocabulary(const Path& file, const Vocabulary& vocabulary);
/// The checks of reading, for a vocabulary in memory. Linear in its size.
void check_vocabulary(const Vocabulary& vocabulary, const std::string& where);

/// What is allowed in a vocabulary but may be meant otherwise: concepts without labels or with labels that others have too,
/// languages that only some concepts are labelled in, rules that contradict each other where both apply.
std::vector<Finding> examine(const Vocabulary& vocabulary);

/// Answers questions about a vocabulary, which must have passed check_vocabulary and outlive this. Construction is linear. Keeps
/// the attribute names of the concepts asked for: not for several threads at once.
class VocabularySearch {
public:
    explicit VocabularySearch(const Vocabulary& vocabulary);

    /// Concepts a tag may mean (indices): the one whose id it is, to the letter; otherwise those that have it as a label in any
    /// language, whatever its case and blanks; otherwise the same without a number at the end ("flower 3" is a flower). More
    /// than one where the tag is ambiguous, none where it is unknown.
    [[nodiscard]] std::vector<std::size_t> concepts_of(const std::string& tag) const;
    /// The only such concept, or none.
    [[nodiscard]] std::optional<std::size_t> concept_of(const std::string& tag) const;
    /// The concept of an id.
    [[nodiscard]] std::optional<std::size_t> find(const std::string& id) const;
    /// Is the concept the other one, or narrower?
    [[nodiscard]] bool is_a(std::size_t concept_index, std::size_t other) const;
    /// The concept and all broader ones, nearest first.
    [[nodiscard]] std::vector<std::size_t> lineage(std::size_t concept_index) const;
    /// The concepts that it is a part of, by its own statement or that of a broader concept, then those that these are parts of;
    /// by levels, nearest first.
    [[nodiscard]] std::vector<std::vector<std::size_t>> wholes_of(std::size_t concept_index) const;
    /// What the concept may carry: its own attributes, those of broader ones, those of every concept; where one name stands
    /// twice, the nearer.
    [[nodiscard]] std::vector<const AllowedAttribute*> attributes_of(std::size_t concept_index) const;
    /// The allowed attribute of a name or label, or nullptr.
    [[nodiscard]] const AllowedAttribute* attribute_of(std::size_t concept_index, const std::string& name) const;
    /// The attribute of that name among those every concept may carry, or nullptr.
    [[nodiscard]] const AllowedAttribute* common_attribute(const std::string& name) const;
    /// Ids and labels close to a text, closest first.
    [[nodiscard]] std::vector<std::string> suggestions(const std::string& tag) const;
    /// The concept's label in a language, or in none, or in English, or in any; the id if it has no label.
    [[nodiscard]] std::string label(std::size_t concept_index, const std::string& language) const;

    [[nodiscard]] const Vocabulary& vocabulary() const { return vocabulary_; }

private:
    const Vocabulary& vocabulary_;
    std::unordered_map<std::string, std::size_t> ids_;
    std::unordered_map<std::string, std::vector<std::size_t>> labels_;  ///< folded text -> concepts
    std::unordered_map<std::string, const AllowedAttribute*> common_;   ///< folded names of what every concept may carry
    /// By concept, the attributes of folded names and labels.
    mutable std::unordered_map<std::size_t, std::unordered_map<std::string, const AllowedAttribute*>> attributes_;
    std::vector<std::vector<std::size_t>> broader_, part_of_;
};

/// The word of an attribute's list that a text means, by name or label; nullptr if none.
const Term* term_of(const AllowedAttribute& attribute, const std::string& text);

struct CheckVocabularyOptions {
    bool strict = false;  ///< quantities that the vocabulary does not have are defects as well

    void describe(OptionList& visit);
};

/// Which tags and attributes of a set do not fit. Defects: a tag that no concept has or that several have, a qualitative
/// attribute that the concept may not carry, a value outside its list, a word where a number belongs and the reverse, a quantity
/// outside its range or in a unit that cannot be converted. Names what comes close. Remarks: quantities that the vocabulary
/// does not have (defects if `strict`), stale quantities and quantities without a unit, whose range was not looked at.
std::vector<Finding> check_against_vocabulary(const AnnotationSet& set, const Vocabulary& vocabulary,
                                              const CheckVocabularyOptions& options = {});
/// Throws Error (input) with the first defect if there is one; `where` names the file of the set.
void require_vocabulary(const AnnotationSet& set, const Vocabulary& vocabulary, const std::string& where,
                        const CheckVocabularyOptions& options = {});

}  // namespace ostraka
