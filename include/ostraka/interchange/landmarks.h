// Landmark files: named points with coordinates, as used by morphometry and picking tools. doc/interchange.md states what each
// format stores.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/core/options.h"
#include "ostraka/files/provenance.h"

namespace ostraka {

/// A named point.
struct Landmark {
    std::string name;                  ///< name of the landmark
    std::array<double, 3> position{};  ///< coordinates in the space and unit of the mesh
    /// Id of the annotation to which the landmark belongs; none if the file does not give it.
    std::optional<int> group;
};

/// A curve through points that need not be connected by edges.
struct LandmarkCurve {
    std::string name;                           ///< name of the curve
    bool closed = false;                        ///< true: the last point is connected to the first point, which is not repeated
    std::vector<std::array<double, 3>> points;  ///< coordinates of the points, in the space and unit of the mesh
    /// Id of the annotation to which the curve belongs; none if the file does not give it.
    std::optional<int> group;
};

/// The content of a landmark file.
struct LandmarkSet {
    std::vector<Landmark> landmarks;    ///< named points
    std::vector<LandmarkCurve> curves;  ///< curves; only in the format mrk
    std::string unit;                   ///< unit of the coordinates; empty if the file does not give it
    std::vector<std::string> notes;     ///< messages about content of the file that was not kept
};

/// Format of a landmark file.
enum class LandmarkFormat {
    csv,  ///< a table with the columns x, y, z and optionally name and id
    tps,  ///< Rohlf's tps, three-dimensional (LM3)
    pp,   ///< MeshLab's picked points
    mrk,  ///< 3D Slicer markups in JSON: points, lines, curves
    fcsv  ///< 3D Slicer's older table format for points
};

/// Anatomical coordinate system: x and y increase to the left and to posterior (lps), or to the right and to anterior (ras).
enum class AnatomicalSpace { lps, ras };

/// Options for reading and writing landmark files.
struct LandmarkFileOptions {
    AnatomicalSpace mesh_space = AnatomicalSpace::lps;  ///< space of the mesh's coordinates
    std::string specimen;  ///< specimen to read from a TPS file: its ID, or its number in the file, from 1

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Reads landmarks. x and y are negated if the file declares LPS or RAS and the mesh uses the other coordinate system. Points
/// not picked yet are skipped with a note. Throws Error (input) with file, position and remedy.
LandmarkSet read_landmarks(const Path& file, LandmarkFormat format, const LandmarkFileOptions& options = {});

/// Reads landmarks from the bytes of a landmark file into the space of the mesh; `where` names the file in error messages.
LandmarkSet landmarks_from_text(const std::string& bytes, LandmarkFormat format, const std::string& where,
                                const LandmarkFileOptions& options = {});

/// The contents of a landmark file. `mesh_file`: name of the mesh file, which is written if the format allows it. Names are
/// escaped so that they cannot act as markup, scripts or formulas. `notes` reports what the format cannot store.
std::string landmarks_to_text(const LandmarkSet& set, LandmarkFormat format, const std::string& mesh_file,
                              const Provenance& provenance, std::vector<std::string>& notes,
                              const LandmarkFileOptions& options = {});

/// The points and poly-lines of a set: an annotation of one point becomes a landmark named by its tag; an annotation of several
/// points becomes landmarks "tag 1", "tag 2" ...; a poly-line becomes a curve. Landmarks cannot represent regions, colours,
/// attributes and, in formats other than mrk, poly-lines; notes give the number of regions, poly-lines and attributes (of
/// exported annotations) that were left out.
LandmarkSet landmarks_of(AnnotatedMeshView object, LandmarkFormat format = LandmarkFormat::mrk);

/// Options for placing points on a mesh.
struct PlaceOptions {
    /// Max distance of a point from the surface, as a fraction of the diagonal of the mesh's bounding box.
    double tolerance = 0.02;
    /// True: points beyond the tolerance are skipped with a note; false: points beyond the tolerance are an error.
    bool skip_far = false;

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Position of an imported annotation on the mesh.
struct PlacedAnnotation {
    int id = 0;              ///< id of the annotation
    std::string tag;         ///< tag of the annotation
    std::size_t points = 0;  ///< number of points of the annotation that were placed
    double to_surface = 0;   ///< maximum distance of the annotation's imported points from the surface, in the mesh's unit
    /// Maximum distance of the annotation's imported points from the vertices that represent them, in the mesh's unit.
    double to_vertex = 0;
    /// "places": placed by coordinates; "indices": by the indices in the file; "whole": the whole mesh.
    std::string how = "places";
};

/// Annotations read from a file, and how each was placed on the mesh.
struct PlacedAnnotations {
    AnnotationSet set;
    std::vector<PlacedAnnotation> placements;  ///< one per annotation that was read
};

/// Makes annotations from landmarks: each landmark becomes a point at the closest vertex (the lower index at equal distance), the
/// landmarks of one group become one annotation, and each curve becomes a poly-line of shortest paths through the vertices
/// closest to its points. If landmarks are beyond the tolerance, for example in a file in RAS space for a mesh in LPS space,
/// throws Error (input) with the farthest landmark and a remedy. Time: O((n + k) log n) for n vertices and k landmarks, not
/// counting the paths.
PlacedAnnotations place_landmarks(const Mesh& mesh, const LandmarkSet& landmarks, const std::string& where,
                                  const PlaceOptions& options = {});

}  // namespace ostraka
