// From what annotations should be to constraints on points: one function a type.
#pragma once

#include "ostraka/relation/check.h"
#include "ostraka/semantic/edit.h"
#include "ostraka/solver/constraint.h"

namespace ostraka::semantic {

/// What lowering reads. `rest` are the mesh's points before the edit, a column each.
struct Shape {
    const Mesh& mesh;
    const AnnotationSet& set;
    const Points& rest;
};

struct Lowered {
    std::vector<std::unique_ptr<Constraint>> constraints;
    std::vector<Index> anchors;  ///< vertices that are to stay where the edit leaves them
};

/// Low-level constraints of one relationship that is a constraint. Throws Error (input) naming it where it makes no sense.
Lowered lower(const Shape& shape, const Relationship& relationship, const std::string& where);

/// The measured state of a constraint on each of some meshes of the same connectivity, with its tolerances.
struct Measured {
    Verdict verdict = Verdict::unknown;
    std::vector<Deviation> deviations;
    std::string text;
};
std::vector<Measured> measure(const Shape& shape, const std::vector<const Mesh*>& deformed, const Relationship& relationship,
                              const RelationOptions& tolerances, const std::string& where);

Points columns_of(const Mesh& mesh);

}  // namespace ostraka::semantic
