// Proposes the fixed proportions of a collection as constraints on a template.
#pragma once

#include "ostraka/collection/measure_definitions.h"
#include "ostraka/collection/proportions.h"
#include "ostraka/core/options.h"
#include "ostraka/relation/graph.h"

namespace ostraka {

/// Options of `propose_proportions`.
struct ProposalOptions {
    bool stable = false;  ///< true: propose stable ratios too, not only fixed ratios
    double weight = 1;    ///< weight of the proposed constraints
    bool hard = false;    ///< true: propose hard constraints

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Constraints proposed from the fixed proportions of a collection.
struct Proposals {
    AnnotationSet set;               ///< annotations of the template, with the measures that the constraints refer to
    RelationGraph graph;             ///< the existing relationships, and a constraint "proportion" for each proposal
    std::size_t proposed = 0;        ///< number of proposed constraints
    std::vector<std::string> notes;  ///< messages about ratios that were not proposed
};

/// For each fixed ratio (with option `stable`, also for each stable ratio), proposes a constraint that keeps the ratio of the
/// smaller to the larger measure between the observed quantiles of this ratio. The constrained part is the annotation of the
/// smaller measure; its reference is the annotation of the larger measure. Measures that the template's annotations do not have
/// yet are taken on the template and added. Notes report ratios that cannot be proposed: one of the measures belongs to the
/// whole object, is a descriptor, belongs to the same annotation as the other measure, or cannot be taken on the template.
/// `existing` may be empty; constraints that `existing` already contains are not repeated.
Proposals propose_proportions(AnnotatedMeshView template_object, RelationGraph existing, const MeasureDefinitions& definitions,
                              const ProportionStudy& study, const ProposalOptions& options = {});

}  // namespace ostraka
