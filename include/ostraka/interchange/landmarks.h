// Landmarks: named points with coordinates, as used by morphometry and picking tools. doc/interchange.md states what each
// format stores.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/core/options.h"
#include "ostraka/files/provenance.h"

namespace ostraka {

struct Landmark {
    std::string name;
    std::array<double, 3> position{};  ///< in the space and unit of the mesh
    std::optional<int> group;          ///< id of its annotation, if the file gives it
};

/// A curve through points that need not be connected by edges.
struct LandmarkCurve {
    std::string name;
    bool closed = false;  ///< the last point is connected to the first, which is not repeated
    std::vector<std::array<double, 3>> points;
    std::optional<int> group;
};

struct LandmarkSet {
    std::vector<Landmark> landmarks;
    std::vector<LandmarkCurve> curves;
    std::string unit;                ///< unit of the coordinates; empty if the file does not give it
    std::vector<std::string> notes;  ///< messages about content of the file that is not kept
};

enum class LandmarkFormat {
    csv,  ///< a table with the columns x, y, z and optionally name and id
    tps,  ///< Rohlf's tps, three-dimensional (LM3)
    pp,   ///< MeshLab's picked points
    mrk,  ///< 3D Slicer markups in JSON: points, lines, curves
    fcsv  ///< 3D Slicer's older table format for points
};

/// Directions of the x and y axes: left and posterior (lps), or right and anterior (ras).
enum class AnatomicalSpace { lps, ras };

struct LandmarkFileOptions {
    AnatomicalSpace mesh_space = AnatomicalSpace::lps;
    std::string specimen;

    void describe(OptionList& visit);
};

/// Reads landmarks into the space of the mesh: x and y are negated if the file declares LPS or RAS and the mesh uses the other.
/// Points not picked yet are skipped with a note. Throws Error (input) with file, position and remedy.
LandmarkSet read_landmarks(const Path& file, LandmarkFormat format, const LandmarkFileOptions& options = {});

/// The same for the bytes of a file; `where` is its name in error messages.
LandmarkSet landmarks_from_text(const std::string& bytes, LandmarkFormat format, const std::string& where,
                                const LandmarkFileOptions& options = {});

/// The contents of a landmark file. `mesh_file` is mentioned if the format allows it. Texts are escaped: no name can become
/// markup, a script or a formula. `notes` reports what the format cannot store.
std::string landmarks_to_text(const LandmarkSet& set, LandmarkFormat format, const std::string& mesh_file,
                              const Provenance& provenance, std::vector<std::string>& notes,
                              const LandmarkFileOptions& options = {});

/// The points and poly-lines of a set: an annotation of one point becomes a landmark named by its tag, one of several points
/// becomes "tag 1", "tag 2" ...; a poly-line becomes a curve. Not representable are regions, colours, attributes and, in
/// formats other than mrk, poly-lines; notes give their numbers, for attributes those of the exported annotations.
LandmarkSet landmarks_of(AnnotatedMeshView object, LandmarkFormat format = LandmarkFormat::mrk);

struct PlaceOptions {
    double tolerance = 0.02;
    bool skip_far = false;

    void describe(OptionList& visit);
};

/// Position of an imported annotation on the mesh.
struct PlacedAnnotation {
    int id = 0;  ///< id of the annotation
    std::string tag;
    std::size_t points = 0;      ///< number of its points placed
    double to_surface = 0;       ///< maximum distance of a point from the surface
    double to_vertex = 0;        ///< maximum distance of a point from the vertex that represents it
    std::string how = "places";  ///< "places": by coordinates; "indices": by the indices in the file; "whole": the whole mesh
};

struct PlacedAnnotations {
    AnnotationSet set;
    std::vector<PlacedAnnotation> placements;
};

/// Annotations from landmarks: each landmark becomes a point at the nearest vertex (the lower index if equally near), the
/// landmarks of one group become one annotation, and each curve becomes a poly-line through the nearest vertices, connected by
/// shortest paths. Throws Error (input) with the farthest landmark beyond the tolerance and a remedy; among others, it detects
/// a file in RAS for a mesh in LPS. O((n + k) log n) for n vertices and k landmarks, not counting the paths.
PlacedAnnotations place_landmarks(const Mesh& mesh, const LandmarkSet& landmarks, const std::string& where,
                                  const PlaceOptions& options = {});

}  // namespace ostraka
