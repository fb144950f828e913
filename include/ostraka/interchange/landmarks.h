// Landmarks: named places with coordinates, as morphometry and picking tools keep them. doc/interchange.md says what each format
// holds.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/options.h"
#include "ostraka/core/provenance.h"

namespace ostraka {

struct Landmark {
    std::string name;
    std::array<double, 3> position{};  ///< in the space and unit of the mesh
    std::optional<int> group;          ///< id of the annotation it belongs to, where the file says so
};

/// A curve through points that need not be joined by edges.
struct LandmarkCurve {
    std::string name;
    bool closed = false;  ///< the last point is joined to the first, which is not repeated
    std::vector<std::array<double, 3>> points;
    std::optional<int> group;
};

struct LandmarkSet {
    std::vector<Landmark> landmarks;
    std::vector<LandmarkCurve> curves;
    std::string unit;                ///< of the coordinates; empty where the file does not say
    std::vector<std::string> notes;  ///< what the file held that is not kept, in words
};

enum class LandmarkFormat {
    csv,  ///< a table with the columns x, y, z and, if there are, name and id
    tps,  ///< Rohlf's tps, three-dimensional (LM3)
    pp,   ///< MeshLab's picked points
    mrk,  ///< 3D Slicer markups in JSON: points, lines, curves
    fcsv  ///< 3D Slicer's older table of points
};

/// Where x and y grow: to the left and to the back, or to the right and to the front.
enum class AnatomicalSpace { lps, ras };

struct LandmarkFileOptions {
    AnatomicalSpace mesh_space = AnatomicalSpace::lps;
    std::string specimen;

    void describe(OptionList& visit);
};

/// Reads landmarks into the space of the mesh: files that say LPS or RAS are turned where the mesh has the other. Places not yet
/// picked are left out with a note. Throws Error (input) that names file, place and remedy.
LandmarkSet read_landmarks(const Path& file, LandmarkFormat format, const LandmarkFileOptions& options = {});

/// The same for a file's bytes; `where` stands for its name in errors.
LandmarkSet landmarks_from_text(const std::string& bytes, LandmarkFormat format, const std::string& where,
                                const LandmarkFileOptions& options = {});

/// The bytes of a landmark file. `mesh_file` is named where the format has room for it. Texts are data: no name can become
/// markup, a script or a formula. Notes say what the format cannot hold.
std::string landmarks_to_text(const LandmarkSet& set, LandmarkFormat format, const std::string& mesh_file,
                              const Provenance& provenance, std::vector<std::string>& notes,
                              const LandmarkFileOptions& options = {});

/// The points and poly-lines of a set: an annotation of one point gives a landmark named by its tag, one of several points gives
/// "tag 1", "tag 2" ...; a poly-line gives a curve. Regions, colours and attributes have no place, nor
/// have poly-lines in formats other than mrk; notes count them, attributes where the annotation itself has a place.
LandmarkSet landmarks_of(const Mesh& mesh, const AnnotationSet& set, LandmarkFormat format = LandmarkFormat::mrk);

struct PlaceOptions {
    double tolerance = 0.02;
    bool skip_far = false;

    void describe(OptionList& visit);
};

/// Where something of the file came to lie on the mesh.
struct PlacedAnnotation {
    int id = 0;  ///< of the annotation
    std::string tag;
    std::size_t points = 0;      ///< how many of its points were placed
    double to_surface = 0;       ///< the largest distance from a point to the surface
    double to_vertex = 0;        ///< the largest distance from a point to the vertex that stands for it now
    std::string how = "places";  ///< "places": by coordinates; "indices": those of the file; "whole": the whole mesh
};

struct PlacedAnnotations {
    AnnotationSet set;
    std::vector<PlacedAnnotation> placements;
};

/// Annotations from landmarks: each landmark becomes a point at the nearest vertex (lower index of equally near ones), those of
/// one group one annotation; each curve becomes a poly-line over the nearest vertices, joined by shortest paths. Throws Error
/// (input) naming the farthest landmark beyond the tolerance and a remedy; among others it sees where the file is in RAS and the
/// mesh in LPS. O((n + k) log n) for n vertices and k landmarks, but for the paths.
PlacedAnnotations place_landmarks(const Mesh& mesh, const LandmarkSet& landmarks, const std::string& where,
                                  const PlaceOptions& options = {});

}  // namespace ostraka
