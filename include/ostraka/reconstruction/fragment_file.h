// Reads a fragment from its files: a mesh or point cloud, and annotations, which may contain facets.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/files/file.h"
#include "ostraka/fracture/facets.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/point_cloud/point_cloud.h"

namespace ostraka {

struct FragmentFileOptions {
    enum class FacetSource { either, annotated, automatic, none };
    /// Source of the facets. annotated: annotations; automatic: classification by shape; either: annotations if they contain
    /// facets, otherwise the shape if the mesh has no opening; none: all faces are outer surface.
    FacetSource facets = FacetSource::either;
    FacetOptions finding;  ///< options for finding facets from the shape
    CloudOptions cloud;    ///< options for reconstructing the surface of a point cloud

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// A fragment that was read, with the source of its data.
struct FragmentFile {
    Fragment fragment;        ///< mesh, annotations and facets of the fragment
    std::string facets_from;  ///< source of the facets: "annotations", "shape", "shape and annotations" or "nowhere"
    Facets found;             ///< facets found from the shape, if they were computed
    bool points = false;      ///< true: the file has no faces, and the mesh is reconstructed from its points
    /// Colour of each face, the mean over the face of image and own colours; empty: the file has no colours.
    std::vector<Colour> face_colours;
    std::vector<Path> inputs;        ///< the files that were read
    std::vector<std::string> notes;  ///< messages about the files
};

/// Reads a mesh and, if present, the annotations beside the mesh (NAME.ant.json), or points without faces (annotations beside
/// points are not read; a note reports this). The faces of a closed mesh that is inside out are turned over, with a note. The
/// facets come from the source in the options. Fracture segments found from the shape count only if their confidence is above
/// 0.5. Throws Error (input).
FragmentFile read_fragment(const Path& file, const FragmentFileOptions& options = {});

/// Makes annotations from facets: up to three regions "outer", "inner" and "fracture", with area and confidence as attributes.
AnnotationSet facet_annotations(const Facets& facets, const std::string& unit = {});

/// Updates a set with the facets. The first region named "outer", "inner" or "fracture" (case-insensitive) keeps id, tag, colour
/// and other attributes, and gets the faces, area and confidence of this facet; further regions of that name and regions of
/// missing facets are removed; other annotations are kept. Measures of a region whose faces change become stale.
void update_facet_annotations(AnnotationSet& set, const Facets& facets);

}  // namespace ostraka
