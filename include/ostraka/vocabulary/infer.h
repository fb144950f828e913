// Inference rules that derive qualitative from quantitative attributes (thesis, section 2.2.3).
#pragma once

#include "ostraka/vocabulary/vocabulary.h"

namespace ostraka {

/// An attribute that a rule added to an annotation.
struct Inference {
    int annotation = 0;            ///< id of the annotation
    std::string attribute, value;  ///< name and value of the attribute
    std::string rule;              ///< id of the first rule that derived the attribute
    std::string why;               ///< the rule and its inputs, as text
};

/// Result of applying inference rules.
struct InferenceResult {
    AnnotationSet annotations;        ///< annotations with the inferred attributes, whose `origin` names the rule
    std::vector<Inference> inferred;  ///< the inferred attributes
    /// Messages about rules that were not applied, because they contradict each other or an attribute stated by a person.
    std::vector<std::string> contradictions;
    std::vector<std::string> missing;  ///< messages about rules that could not be evaluated, with the missing input
};

/// Applies the vocabulary's inference rules to every annotation whose tag names exactly one concept. A rule applies if all its
/// conditions hold; inferred attributes are inputs of other rules. If applicable rules contradict each other, the attribute is
/// omitted and the contradiction is reported; attributes stated by a person are kept, and a rule that contradicts them is
/// reported. Attributes inferred earlier are removed first, so that inference is idempotent. Bounds without a unit are in the
/// unit that the vocabulary states for the attribute.
InferenceResult infer(const AnnotationSet& set, const Vocabulary& vocabulary);

/// The unit of the bounds of a condition: the unit that the condition states, or the unit of the vocabulary's attribute; empty if
/// neither is stated, and for a ratio.
std::string condition_unit(const VocabularySearch& search, const InferenceRule& rule, const Condition& condition);

}  // namespace ostraka
