// From numbers to words: qualitative attributes that rules infer from quantitative ones (thesis, section 2.2.3).
#pragma once

#include "ostraka/vocabulary/vocabulary.h"

namespace ostraka {

/// An attribute that rules gave an annotation.
struct Inference {
    int annotation = 0;
    std::string attribute, value;
    std::string rule;  ///< id of the first rule that says so
    std::string why;   ///< the rule and its inputs, in words
};

struct InferenceResult {
    AnnotationSet annotations;  ///< with the attributes inferred, their `origin` says why
    std::vector<Inference> inferred;
    std::vector<std::string> contradictions;  ///< rules that disagree with each other or with what was stated; none was believed
    std::vector<std::string> missing;         ///< rules that could not be judged, and what they lack
};

/// Applies the vocabulary's rules to every annotation whose tag means one concept. A rule holds if all its conditions do; words
/// inferred by one rule are inputs of others. Where rules that hold disagree, the attribute is left out and the rules are named;
/// what a person stated stays, and a rule that says otherwise is named. Attributes that rules gave earlier are taken away first,
/// so that inferring again gives the same. Bounds without a unit are in the unit the vocabulary gives the attribute.
InferenceResult infer(const AnnotationSet& set, const Vocabulary& vocabulary);

/// The unit of a condition's bounds: its own, or that of the vocabulary's attribute; empty if neither is stated or for a ratio.
std::string condition_unit(const VocabularySearch& search, const InferenceRule& rule, const Condition& condition);

}  // namespace ostraka
