// An annotated mesh, the central idea of the toolkit (doc/architecture.md): a mesh with annotations of its parts.
#pragma once

#include "ostraka/annotation/annotation.h"

namespace ostraka {

/// A mesh with its annotations, which refer to vertices and faces of this mesh.
struct AnnotatedMesh {
    Mesh mesh;
    AnnotationSet annotations;
};

/// Read-only reference to a mesh and its annotations; both must outlive it. Functions take this type instead of AnnotatedMesh
/// because most callers store the mesh and the annotations in separate objects and would have to copy the mesh. One mesh may
/// have several annotation sets, and one set may belong to several deformed shapes of a mesh. A function that changes the
/// annotations takes `const Mesh&` and `AnnotationSet&` instead.
struct AnnotatedMeshView {
    AnnotatedMeshView(const AnnotatedMesh& object) : AnnotatedMeshView(object.mesh, object.annotations) {}
    AnnotatedMeshView(const Mesh& object_mesh, const AnnotationSet& set) : mesh(object_mesh), annotations(set) {}

    const Mesh& mesh;
    const AnnotationSet& annotations;
};

}  // namespace ostraka
