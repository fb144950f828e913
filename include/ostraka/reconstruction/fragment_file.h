// Reads a fragment from its files: mesh or points, annotations, facets.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/files/file.h"
#include "ostraka/fracture/facets.h"
#include "ostraka/point_cloud/point_cloud.h"

namespace ostraka {

struct FragmentFileOptions {
    enum class FacetSource { either, annotated, automatic, none };
    FacetSource facets = FacetSource::either;
    FacetOptions finding;
    CloudOptions cloud;

    void describe(OptionList& visit);
};

struct FragmentFile {
    Fragment fragment;
    std::string facets_from;   ///< "annotations", "shape", "shape and annotations" or "nowhere"
    Facets found;              ///< facets from the shape, if they were computed
    bool points = false;       ///< the file has no faces: the mesh is reconstructed from its points
    std::vector<Path> inputs;  ///< files that were read
    std::vector<std::string> notes;
};

/// Reads a mesh and the annotations beside it (NAME.ant.json) if they exist, or points without faces (annotations beside them
/// are not read; a note reports this); facets by the options. Fracture segments found from the shape count only if their
/// confidence is above 0.5. Throws Error (input).
FragmentFile read_fragment(const Path& file, const FragmentFileOptions& options = {});

/// The facets as up to three regions "outer", "inner" and "fracture", with area and confidence.
AnnotationSet facet_annotations(const Facets& facets, const std::string& unit = {});

/// Updates a set with the facets: its first region of each name (case-insensitive) keeps id, tag, colour and other attributes,
/// and gets the faces, area and confidence of the facet; further regions of that name and those of missing facets are removed;
/// other annotations are kept. Measures of a region whose faces change become stale.
void update_facet_annotations(AnnotationSet& set, const Facets& facets);

}  // namespace ostraka
