#include "measured_object.h"

namespace ostraka {

Slot& MeasuredObject::describe(Parameters& p) {
    p.input("mesh", Kind::mesh, mesh, "mesh file");
    Slot& named = p.input_option("annotations", Kind::annotations, annotations,
                                 "its annotations (.ant.json); the whole object is measured if left out");
    p.output_option("output", Kind::annotations, output, "annotations to write, with the values as attributes (.ant.json)");
    p.options("unit", unit, "unit of the coordinates, where the annotations do not say (any text, such as mm)");
    return named;
}

AnnotationSet MeasuredObject::read(Report& report) const {
    AnnotationSet set;
    if (annotations) set = annotations.on(mesh->mesh);
    else ensure_root(set, mesh->mesh);
    if (!unit.empty() && !set.unit.empty() && set.unit != unit)
        report.note("the annotations are in " + set.unit + ", not in " + unit + "; theirs counts");
    if (set.unit.empty()) set.unit = unit;
    return set;
}

Annotation& MeasuredObject::one(AnnotationSet& set, const std::string& name) const {
    if (!annotations)
        fail_usage("--annotation '" + printable(name, 60) + "' names a part of " + printable(mesh.file(), 60) +
                       ", but no annotation file is given",
                   "add --annotations FILE");
    return *set.find(find_annotation(set, name, file()).id);
}

void MeasuredObject::write(AnnotationSet set) const {
    if (output) output.write(std::move(set), mesh->mesh, mesh.file());
}

}  // namespace ostraka
