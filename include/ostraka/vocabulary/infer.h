// Inference rules that derive qualitative from quantitative attributes (thesis, section 2.2.3).
#pragma once

#include "ostraka/vocabulary/vocabulary.h"

namespace ostraka {

/// An attribute that a rule added to an annotation.
struct Inference {
    int annotation = 0;
    std::string attribute, value;
    std::string rule;  ///< id of the first rule that derived it
    std::string why;   ///< the rule and its inputs, as text
};

struct InferenceResult {
    AnnotationSet annotations;  ///< with the inferred attributes; their `origin` names the rule
    std::vector<Inference> inferred;
    std::vector<std::string> contradictions;  ///< rules that contradict each other or stated attributes; none of them was
                                              ///< applied
    std::vector<std::string> missing;         ///< rules that could not be evaluated, and the missing input
};

/// Applies the vocabulary's rules to every annotation whose tag means exactly one concept. A rule holds if all its conditions
/// hold; inferred attributes are inputs of other rules. If rules that hold contradict each other, the attribute is omitted and
/// the contradiction reported; attributes stated by a person are kept, and a rule that contradicts them is reported. Attributes
/// inferred earlier are removed first, so that inference is idempotent. Bounds without a unit are in the unit that the
/// vocabulary gives the attribute.
InferenceResult infer(const AnnotationSet& set, const Vocabulary& vocabulary);

/// The unit of a condition's bounds: the condition's own, or that of the vocabulary's attribute; empty if neither is given, and
/// for a ratio.
std::string condition_unit(const VocabularySearch& search, const InferenceRule& rule, const Condition& condition);

}  // namespace ostraka
