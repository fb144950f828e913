#include "operations/measure/measured_object.h"

#include <fmt/core.h>

namespace ostraka {

Slot& MeasuredObject::declare(Parameters& p) {
    p.input("mesh", Kind::mesh, mesh, "mesh file");
    Slot& annotations_slot = p.input_option("annotations", Kind::annotations, annotations,
                                            "annotations of the mesh (.ant.json); if left out, the whole object is measured");
    p.output_option("output", Kind::annotations, output,
                    "annotations to write (.ant.json), with the computed values as attributes");
    p.options("unit", unit, "unit of the coordinates (any text, such as mm), if the annotations do not state a unit");
    return annotations_slot;
}

AnnotationSet MeasuredObject::read(Report& report) const {
    AnnotationSet set;
    if (annotations) set = annotations.on(mesh->mesh);
    else ensure_root(set, mesh->mesh);
    if (!unit.empty() && !set.unit.empty() && set.unit != unit)
        report.note(fmt::format("the annotations are in {}, not in {}; their unit is used", set.unit, unit));
    if (set.unit.empty()) set.unit = unit;
    return set;
}

Annotation& MeasuredObject::require_annotation(AnnotationSet& set, const std::string& name) const {
    if (!annotations)
        fail_usage(fmt::format("--annotation '{}' names a part of {}, but no annotation file is given", printable(name, 60),
                               printable(mesh.file(), 60)),
                   "add --annotations FILE");
    return *set.find(find_annotation(set, name, file()).id);
}

void MeasuredObject::write(AnnotationSet set) const {
    if (output) output.write(std::move(set), mesh->mesh, mesh.file());
}

}  // namespace ostraka
