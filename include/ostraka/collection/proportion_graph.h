// Fixed proportions of a collection, proposed as constraints on a template.
#pragma once

#include "ostraka/collection/measure_definitions.h"
#include "ostraka/collection/proportions.h"
#include "ostraka/core/options.h"
#include "ostraka/relation/graph.h"

namespace ostraka {

struct ProposalOptions {
    bool stable = false;
    double weight = 1;
    bool hard = false;

    void describe(OptionList& visit);
};

struct Proposals {
    AnnotationSet set;    ///< annotations of the template, with the measures that the constraints refer to
    RelationGraph graph;  ///< the existing relationships, and a constraint "proportion" for each proposal
    std::size_t proposed = 0;
    std::vector<std::string> notes;  ///< messages on ratios that are not proposed
};

/// For each fixed ratio (with `stable`, also each stable ratio), proposes the constraint that the smaller measure stays in
/// proportion to the larger one, between the observed quantiles of the ratio. The part that changes is the annotation of the
/// smaller measure; the reference is the annotation of the larger one. Measures that the template's annotations do not carry
/// yet are taken and added. Notes report ratios that cannot be proposed: a measure does not have its own annotation (the whole
/// object, descriptors, two measures of one annotation) or cannot be taken on the template. `existing` may be empty;
/// constraints that it already contains are not repeated.
Proposals propose_proportions(AnnotatedMeshView template_object, RelationGraph existing, const MeasureDefinitions& definitions,
                              const ProportionStudy& study, const ProposalOptions& options = {});

}  // namespace ostraka
