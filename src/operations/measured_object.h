// What is measured: a mesh and its annotations or, without a file of them, one annotation that is the whole object.
#pragma once

#include "operations.h"

namespace ostraka {

struct MeasuredObject {
    MeshInput mesh;
    AnnotationsInput annotations;
    AnnotationsOutput output;
    std::string unit;

    /// Slots `mesh`, `annotations` and `output`, and the option `unit`. Returns that of the annotations, which may be left out.
    Slot& describe(Parameters& p);

    /// The annotations to change, with the unit.
    AnnotationSet read(Report& report) const;
    /// By id, or by tag if exactly one annotation has it. Throws Error (usage) where no annotations are given.
    [[nodiscard]] Annotation& one(AnnotationSet& set, const std::string& name) const;
    /// The file that says what is measured.
    [[nodiscard]] std::string file() const { return annotations ? annotations.file() : mesh.file(); }
    /// If it was asked for.
    void write(AnnotationSet set) const;
};

}  // namespace ostraka
