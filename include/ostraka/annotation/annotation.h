// Annotations: statements about parts of a mesh (thesis, section 2.2: A = (I, S, P)).
#pragma once

#include "ostraka/files/json.h"
#include "ostraka/geom/surface_point.h"
#include "ostraka/mesh/mesh.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// A measure and the pins (picked vertices) that define it (Appendix B.1).
struct Measure {
    std::string tool;                     ///< "ruler", "tape" or "bounding"
    std::vector<Index> points;            ///< vertices: two for a ruler, two or more for a tape, two extremes for bounding
    std::vector<SurfacePoint> locations;  ///< empty, or the exact place of the pin for each of `points`, in a face
    std::optional<std::array<double, 3>> direction;  ///< direction of a bounding measure
    std::optional<double> value;                     ///< in `unit`; the mean over the repeated pickings
    std::string unit;
    bool stale = false;  ///< true: the mesh or the pins changed and the value was not recomputed
    bool exact = false;  ///< a tape: along the geodesic across faces ("geodesic": "exact") instead of along edges
    std::vector<std::vector<Index>> repeats = {};      ///< repeated pickings, each as many vertices as `points`
    std::optional<double> uncertainty = std::nullopt;  ///< standard deviation of the value, in `unit`
    bool operator==(const Measure&) const = default;
};

/// A quantity that is not a measure: area, curvature map, thickness ...
struct Descriptor {
    std::vector<double> values;
    bool is_list = false;  ///< written as a list, even if it has one value
    std::string file;      ///< instead of values: map (array: .npy, .txt) or axis (.json), relative to the annotation file
    std::string unit;
    bool stale = false;
    std::string sha256 = {};  ///< checksum of the contents of `file`; empty: unknown
    bool operator==(const Descriptor&) const = default;
};

enum class AttributeType { semantic, measure, descriptor };

struct Attribute {
    int id = 0;
    std::string name;
    AttributeType type = AttributeType::semantic;
    std::string note;       ///< text of a semantic attribute
    Measure measure;        ///< for a measure
    Descriptor descriptor;  ///< for a descriptor
    std::string origin{};   ///< derivation of an inferred semantic attribute, e.g. the rule and its inputs
};

/// Additional information of an annotation (section 2.2.1): a text, a link or a file, with a checksum if the file is local.
struct Information {
    enum class Kind { text, image, link, file } kind = Kind::text;
    std::string value;   ///< the text, or the location of the image, link or file: URL or path relative to the annotation file
    std::string title;   ///< title for display; may be empty
    std::string sha256;  ///< checksum of the contents of a local image or file; empty: unknown
    bool operator==(const Information&) const = default;
    /// True for an image or a file whose location is not a URL.
    [[nodiscard]] bool is_local() const;
};
std::string to_string(Information::Kind kind);

enum class AnnotationType { point, line, region };

/// The colour of annotations that distinguish no part: the whole object.
inline constexpr std::array<int, 3> neutral_colour{190, 190, 190};

/// Selections are indices into the mesh that the annotation belongs to. Exactly one of `points`, `polylines`, `faces` is used.
/// A free annotation has its own curves, which need not follow the edges; its selection then holds the elements nearest to the
/// curves (curves.h).
struct Annotation {
    int id = 0;
    std::string tag;
    std::array<int, 3> colour = neutral_colour;  ///< red, green, blue, 0 to 255
    AnnotationType type = AnnotationType::region;
    std::vector<Index> points;                  ///< vertices, in the order given
    std::vector<std::vector<Index>> polylines;  ///< consecutive vertices connected by edges; closed if first = last
    std::vector<Index> faces;                   ///< faces of the region, ascending, without repeats
    /// Curves of a free annotation, made of stored points (stored_point); consecutive ones lie in a common face. Region:
    /// outlines with the interior to the left, closed (the first point is repeated) or from border to border. Line: poly-lines,
    /// closed if first = last. Point: one point each.
    std::vector<std::vector<SurfacePoint>> curves;
    bool all = false;  ///< the region is the whole mesh: `faces` lists every face
    std::vector<Attribute> attributes;
    std::vector<Information> information;
    std::string note;  ///< changes that a transfer or a simplification made to the annotation, if any
};

struct AnnotationSet {
    AnnotationSet() = default;
    AnnotationSet(const AnnotationSet& other);
    AnnotationSet& operator=(const AnnotationSet& other);
    AnnotationSet(AnnotationSet&&) = default;
    AnnotationSet& operator=(AnnotationSet&&) = default;

    std::string object_class;  ///< "class" in the file
    std::string unit;
    std::optional<std::array<double, 3>> up;
    std::vector<Annotation> annotations;
    Json provenance;                 ///< as read; null if none
    std::vector<std::string> notes;  ///< remarks by the reader or by functions that adapted the set to a changed mesh

    [[nodiscard]] const Annotation* find(int id) const;
    [[nodiscard]] Annotation* find(int id);
};

std::string to_string(AnnotationType type);
/// The annotation as named in messages: "annotation 3 ('spout')".
std::string name_of(const Annotation& annotation);

/// The annotation of the whole object: a region with `all`. If there is none, it is inserted as the first annotation, with the
/// class as its tag ("object" if the class is unknown) and a free id. It holds the attributes of the object itself (total
/// height, site of excavation ...).
Annotation& ensure_root(AnnotationSet& set, const Mesh& mesh);

/// An unused id: one more than the largest, 0 for an empty set.
int free_id(const AnnotationSet& set);

/// The vertices of an annotation, ascending, without repeats: its points, the vertices of its poly-lines or the corners of its
/// faces.
std::vector<Index> touched_vertices(const Mesh& mesh, const Annotation& annotation);

/// The vertices of a measure: its points and those of its repeats.
std::vector<Index> pins_of(const Measure& measure);

/// The common part of measures and descriptors; empty for a semantic attribute.
struct Figures {
    std::vector<double> values;  ///< at most one for a measure
    std::string unit;
    bool stale = false;
};
Figures figures_of(const Attribute& attribute);

/// For each face of the mesh, whether it belongs to the region.
std::vector<bool> face_flags(const Mesh& mesh, const std::vector<Index>& faces);
/// Total area of the faces, added up in the given order.
double area_of(const Mesh& mesh, const std::vector<Index>& faces);
/// The faces whose flag is set, ascending.
std::vector<Index> flagged(const std::vector<bool>& flags);

}  // namespace ostraka
