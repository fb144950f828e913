// An annotated mesh, the central idea of the toolkit (doc/architecture.md): a mesh with annotations of its parts.
#pragma once

#include "ostraka/annotation/annotation.h"

namespace ostraka {

/// A mesh with its annotations, which refer to vertices and faces of this mesh.
struct AnnotatedMesh {
    Mesh mesh;
    AnnotationSet annotations;
};

/// An annotated mesh as functions read it; the mesh and the annotations must outlive it. It is a type of its own because most
/// callers cannot pass an AnnotatedMesh without a copy of the mesh: operations hold meshes and annotations as separate shared
/// objects, as they are separate files; several sets may belong to one mesh, and one set to several shapes of a mesh. A
/// function that changes the annotations takes `const Mesh&` and `AnnotationSet&` instead.
struct AnnotatedMeshView {
    AnnotatedMeshView(const AnnotatedMesh& object) : AnnotatedMeshView(object.mesh, object.annotations) {}
    AnnotatedMeshView(const Mesh& object_mesh, const AnnotationSet& set) : mesh(object_mesh), annotations(set) {}

    const Mesh& mesh;
    const AnnotationSet& annotations;
};

}  // namespace ostraka
