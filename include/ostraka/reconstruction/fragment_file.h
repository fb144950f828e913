// A fragment as its files tell: mesh or points, annotations, facets.
#pragma once

#include "ostraka/core/file.h"
#include "ostraka/core/options.h"
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
    Facets found;              ///< from the shape, where that was asked
    bool points = false;       ///< the file has no faces: the mesh is a surface through its points
    std::vector<Path> inputs;  ///< what was read
    std::vector<std::string> notes;
};

/// Reads a mesh and the annotations beside it (NAME.ant.json) if they are there, or points without faces (with a note where there
/// are annotations beside them: those are not read); facets as the options say. A surface found in a solid counts as fracture
/// only where it is surer than even. Throws Error (input).
FragmentFile read_fragment(const Path& file, const FragmentFileOptions& options = {});

/// The facets as three regions "outer", "inner" and "fracture" (those that are there), with area and confidence.
AnnotationSet facet_annotations(const Facets& facets, const std::string& unit = {});

/// Brings a set up to date with the facets: its first region of each name (capital letters or not) keeps id, tag, colour and
/// what else is said of it, and gets the faces, area and confidence found; further ones and those not found go; others stay.
/// What is measured of a region whose faces change is stale.
void update_facet_annotations(AnnotationSet& set, const Facets& facets);

}  // namespace ostraka
