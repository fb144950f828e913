// The object to measure: a mesh with annotations or, without an annotation file, with one annotation of the whole object.
#pragma once

#include "operations/operations.h"

namespace ostraka {

struct MeasuredObject {
    MeshInput mesh;
    AnnotationsInput annotations;
    AnnotationsOutput output;
    std::string unit;

    /// Declares the slots `mesh`, `annotations` and `output`, and the option `unit`. Returns the annotations slot, which the
    /// caller may make optional.
    Slot& declare(Parameters& p);

    /// The annotations to change, with the unit set.
    AnnotationSet read(Report& report) const;
    /// Finds an annotation by id, or by tag if it is unique. Throws Error (usage) if no annotations are given.
    [[nodiscard]] Annotation& require_annotation(AnnotationSet& set, const std::string& name) const;
    /// The file to name in messages: the annotations, or else the mesh.
    [[nodiscard]] std::string file() const { return annotations ? annotations.file() : mesh.file(); }
    /// Writes the annotations if the output is requested.
    void write(AnnotationSet set) const;
};

}  // namespace ostraka
