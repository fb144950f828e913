// Meshes whose annotations are features: GLB with EXT_mesh_features and EXT_structural_metadata (3D Tiles next).
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/provenance.h"
#include "ostraka/interchange/landmarks.h"

namespace ostraka {

/// The mesh in the colours of its annotations, with a row of one property table for each annotation (id, tag, kind, colour, note,
/// all attributes as JSON, and a column for each name of an attribute that is a number or a text). Regions are feature id sets on
/// the triangles' vertices, which are split at region borders: regions that overlap stand in several sets, the smallest in the
/// first in which they meet no other, so that the first set with a feature at a place tells the smallest region there. Lines and
/// points are primitives of their own. Ids are 16 bit numbers, or floats above 65535 annotations. A vertex attribute _VERTEX
/// holds the index of the vertex in the mesh (up to 2^24). Throws Error (failure) for a mesh without triangles, coordinates
/// beyond single precision or a file beyond four gigabytes. `notes` says what was rounded. Where annotations are free, the mesh
/// is cut along their curves, and the extras of the glTF mesh hold all annotations on the mesh itself, as its own file would
/// (`original`, with its checksum); likewise where one has further information.
std::string feature_glb(const Mesh& mesh, const AnnotationSet& set, const std::string& mesh_file, const Provenance& provenance,
                        std::vector<std::string>& notes);

/// Reads the annotations of such a file onto `mesh`. Where it holds them as they are on this mesh (`original`, by its checksum),
/// and the table has the same ids and tags, they come back without any difference. Where it says that it was made of this mesh
/// (checksum), triangle i is face i and vertices have their indices; elsewhere each face takes the features of the triangle
/// nearest to its centroid, and lines and points go to the nearest vertices. Feature tables of other tools are read if they have
/// one of the properties tag, name and label; nodes with transformations and compressed buffers are refused. Throws Error (input)
/// naming file, place and remedy.
PlacedAnnotations read_feature_glb(const std::string& bytes, const Mesh& mesh, const std::string& where,
                                   const PlaceOptions& options = {});

}  // namespace ostraka
