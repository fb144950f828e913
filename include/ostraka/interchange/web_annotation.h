// Annotations as linked data: W3C Web Annotation Data Model (Recommendation of 23 February 2017) in JSON-LD.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/files/provenance.h"
#include "ostraka/interchange/landmarks.h"

namespace ostraka {

/// An AnnotationCollection with one embedded AnnotationPage. Each Annotation has
/// - bodies: a TextualBody with the tag (purpose "tagging"), one per semantic attribute and one per value in readable form
///   (purpose "describing"), and one with all data as JSON (format "application/json");
/// - a target: a SpecificResource whose source is the mesh (file name, counts, checksum of the indexed geometry), with two
///   equivalent selectors: by indices, and by coordinates for other meshes.
/// Identifiers are urn:uuid values computed from the checksum of the mesh and from the annotation, so that they are
/// reproducible. < > & are escaped, so that the text can be embedded in an HTML page. Throws Error (input) if an annotation
/// refers to elements that the mesh does not have.
std::string web_annotations(AnnotatedMeshView object, const std::string& mesh_file, const Provenance& provenance);

/// Reads web annotations: a collection, a page, a list of annotations or a single annotation. If the checksum of the target is
/// the checksum of `mesh`, the indices are used. Otherwise the coordinates are used: points and lines are mapped to the closest
/// vertices, and the outlines of regions are traced along edges and filled. The placements report the method and the distances.
/// Annotations of other tools are read if they have one of these two selectors or refer to the whole mesh; all other
/// annotations are skipped with a note. Throws Error (input) with file, JSON pointer and remedy.
PlacedAnnotations read_web_annotations(const std::string& bytes, const Mesh& mesh, const std::string& where,
                                       const PlaceOptions& options = {});

}  // namespace ostraka
