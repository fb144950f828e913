// Further outputs of annotations: a coloured mesh and face labels.
#pragma once

#include "operations/operations.h"

#include "ostraka/annotation/colouring.h"
#include "ostraka/annotation/label_file.h"

namespace ostraka {

/// Further outputs of annotations: a coloured mesh and face labels.
struct AnnotationPictures {
    MeshOutput coloured;
    FileOutput labels;

    void declare(Parameters& p) {
        p.output_option("ply", Kind::mesh, coloured,
                        "mesh file to write, coloured by its annotations (PLY or another format with colours)");
        p.output_option("labels-out", Kind::labels, labels,
                        "label file to write: for each face, the id of the smallest region that contains the face, or -1");
    }
    void write(AnnotatedMeshView object, Report& report) const {
        if (coloured) coloured.write(object.mesh, colour_by_annotation(object));
        if (!labels) return;
        const FaceLabels face_ids = face_labels(object);
        write_labels(labels.path(), face_ids.of_face);
        if (face_ids.lost > 0)
            report.note(number(100 * face_ids.lost, 3) +
                        " % of the area has another label than its face: free outlines cut faces");
    }
};

}  // namespace ostraka
