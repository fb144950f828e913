// Meshes with annotations as features: GLB with EXT_mesh_features and EXT_structural_metadata (3D Tiles Next).
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/files/provenance.h"
#include "ostraka/interchange/landmarks.h"
#include "ostraka/io/mesh_file.h"

namespace ostraka {

/// Writes the mesh coloured by its annotations as a GLB file, with a property table of one row per annotation (id, tag, kind,
/// colour, note, all attributes as JSON, and a column for each attribute name with a number or a text). Regions are feature id
/// sets on the vertices of the triangles, which are duplicated at region borders. Overlapping regions are in different feature
/// id sets. Regions are processed in the order of increasing size, and each region is put into the first set in which it
/// overlaps no other region. At a given position, the first set with a feature there therefore gives the smallest region. Lines
/// and points are separate primitives. Ids are 16-bit integers, or floats for more than 65535 annotations. A vertex attribute
/// _VERTEX holds the index of the vertex in the mesh (up to 2^24). If annotations are free, the mesh is cut along their curves,
/// and the extras of the glTF mesh contain all annotations on the original mesh, as in an annotation file (`original`, with its
/// checksum); the extras of the glTF mesh also contain all annotations if an annotation has additional information. If the
/// argument `extras` has a texture or colours, the surface is shown with them instead of the colours of annotations, with one
/// primitive per material and unchanged images. `notes` reports rounded values and colours of annotations that are not shown.
/// Throws Error (failure) for a mesh without triangles, coordinates beyond single precision, or a file beyond four gigabytes.
std::string feature_glb(AnnotatedMeshView object, const std::string& mesh_file, const Provenance& provenance,
                        std::vector<std::string>& notes, const MeshExtras& extras = {});

/// Reads the annotations of a GLB file with mesh features and places them on `mesh`. If the file contains the original
/// annotations of this mesh (`original`, by checksum) and its table has the same ids and tags, the original annotations are
/// restored exactly. If the file was made from this mesh (by checksum), triangle i is face i and vertices have their indices;
/// otherwise each face takes the features of the triangle nearest to its centroid, and lines and points are mapped to the
/// nearest vertices. Feature tables of other tools are read if they have one of the properties tag, name and label; nodes with
/// transformations and compressed buffers are refused. Throws Error (input) with file, position and remedy.
PlacedAnnotations read_feature_glb(const std::string& bytes, const Mesh& mesh, const std::string& where,
                                   const PlaceOptions& options = {});

}  // namespace ostraka
