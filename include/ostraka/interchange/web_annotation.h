// Annotations as linked data: W3C Web Annotation Data Model (Recommendation of 23 February 2017) in JSON-LD.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/provenance.h"
#include "ostraka/interchange/landmarks.h"

namespace ostraka {

/// An AnnotationCollection with one embedded AnnotationPage; an Annotation each with
/// - bodies: a TextualBody with the tag (purpose "tagging"), one a semantic attribute and one a value, as people read them
///   (purpose "describing"), and one with all data as JSON (format "application/json");
/// - a target: a SpecificResource whose source is the mesh (file name, counts, checksum of the indexed geometry) and whose two
///   selectors say the same twice: by indices, and by coordinates for meshes with others.
/// Identifiers are urn:uuid made of checksum and annotation, the same on every run. < > & stand as escapes, so that the text may
/// be put into an HTML page. Throws Error (input) if the set does not fit the mesh.
std::string web_annotations(const Mesh& mesh, const AnnotationSet& set, const std::string& mesh_file,
                            const Provenance& provenance);

/// Reads a collection, a page, a list of annotations or one of them. Where the target's checksum is that of `mesh`, the indices
/// are taken; elsewhere the points: nearest vertices for points and lines, and for regions the outlines are drawn anew along
/// edges and filled. Placements say which, and how far points lay. Annotations of other tools are taken if they have a selector
/// of ours or are about the whole mesh; the rest is left out with a note. Throws Error (input) naming file, JSON pointer and
/// remedy.
PlacedAnnotations read_web_annotations(const std::string& bytes, const Mesh& mesh, const std::string& where,
                                       const PlaceOptions& options = {});

}  // namespace ostraka
