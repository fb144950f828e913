// Proportions that a collection keeps, proposed as constraints on a template.
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
    AnnotationSet set;    ///< the template's annotations, with the measures that the constraints name
    RelationGraph graph;  ///< the relationships there were, and a constraint "proportion" for each proposal
    std::size_t proposed = 0;
    std::vector<std::string> notes;  ///< why a ratio is not proposed, in words
};

/// For each ratio that is fixed (with `stable`: or stable), the constraint that the smaller measure stays in proportion to the
/// larger one, between the quantiles of the ratio that were observed. The part that changes is the annotation of the smaller
/// measure, the reference that of the larger one. Measures that the template's annotations do not carry yet are taken and added.
/// What has no annotation of its own (the whole object, descriptors, two measures of one annotation), or cannot be taken on the
/// template, is reported in the notes. `existing` may be empty; constraints that stand there already are not repeated.
Proposals propose_proportions(const Mesh& mesh, const AnnotationSet& set, RelationGraph existing,
                              const MeasureDefinitions& definitions, const ProportionStudy& study,
                              const ProposalOptions& options = {});

}  // namespace ostraka
