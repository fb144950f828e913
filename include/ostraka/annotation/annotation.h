// Annotations: what is said of which part of a mesh (thesis, section 2.2: A = (I, S, P)).
#pragma once

#include "ostraka/core/json.h"
#include "ostraka/core/mesh.h"
#include "ostraka/geom/surface_trace.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// A place on the surface that need not be a vertex.
struct Location {
    Index face = no_index;
    std::array<double, 3> barycentric{1, 0, 0};  ///< weights of corners(mesh, face), summing to one
    bool operator==(const Location&) const = default;
};

/// A measure with the pins that define it (Appendix B.1).
struct Measure {
    std::string tool;                 ///< "ruler", "tape" or "bounding"
    std::vector<Index> points;        ///< vertices: two for a ruler, two or more for a tape, the two extremes for a bounding
    std::vector<Location> locations;  ///< empty, or one per point: where the pin really is
    std::optional<std::array<double, 3>> direction;  ///< of a bounding measure
    std::optional<double> value;                     ///< in `unit`; the mean over the pickings
    std::string unit;
    bool stale = false;  ///< the mesh or the pins changed and the value was not recomputed
    bool exact = false;  ///< a tape along the shortest curve over the faces ("geodesic": "exact") instead of along edges
    std::vector<std::vector<Index>> repeats = {};      ///< the pins picked again, once or more: as many each as `points`
    std::optional<double> uncertainty = std::nullopt;  ///< standard deviation of the value, in `unit`
    bool operator==(const Measure&) const = default;
};

/// A quantity that is not a measure: area, curvature map, thickness ...
struct Descriptor {
    std::vector<double> values;
    bool is_list = false;  ///< a list in the file, even if of one value
    std::string file;      ///< instead of values: an array (.npy, .txt) of a map, or an axis (.json), relative to the annotations
    std::string unit;
    bool stale = false;
    std::string sha256 = {};  ///< of the bytes of `file`; empty where it is not known
    bool operator==(const Descriptor&) const = default;
};

enum class AttributeType { semantic, measure, descriptor };

struct Attribute {
    int id = 0;
    std::string name;
    AttributeType type = AttributeType::semantic;
    std::string note;       ///< semantic
    Measure measure;        ///< measure
    Descriptor descriptor;  ///< descriptor
    std::string origin{};   ///< semantic: how the word came about where no person stated it, e.g. the rule and its inputs
};

/// What an annotation refers to besides its tag (section 2.2.1): words, a link, or a file, with its checksum when that is a local
/// one.
struct Information {
    enum class Kind { text, image, link, file } kind = Kind::text;
    std::string value;   ///< the text, or where the image, link or file is: a URL, or a path relative to the annotation file
    std::string title;   ///< what people read for it; may be empty
    std::string sha256;  ///< of the bytes of a local image or file; empty where it is not known
    bool operator==(const Information&) const = default;
    /// An image or a file that is no URL.
    [[nodiscard]] bool is_local() const;
};
std::string to_string(Information::Kind kind);

enum class AnnotationType { point, line, region };

/// The colour of what tells no part from another: the whole object.
inline constexpr std::array<int, 3> neutral_colour{190, 190, 190};

/// Selections are plain indices of the mesh they belong to. Exactly one of `points`, `polylines`, `faces` is used. A free
/// annotation has curves of its own, which need not follow the edges; its elements then are the nearest to them (curves.h).
struct Annotation {
    int id = 0;
    std::string tag;
    std::array<int, 3> colour = neutral_colour;  ///< red, green, blue, 0 to 255
    AnnotationType type = AnnotationType::region;
    std::vector<Index> points;                  ///< vertices, in the order given
    std::vector<std::vector<Index>> polylines;  ///< successive vertices joined by edges; closed when first = last
    std::vector<Index> faces;                   ///< the region's faces, ascending, without repeats
    /// Of a free annotation, neighbours in one face: each the outline of a region, its interior to the left, closed (the first
    /// place is repeated) or from border to border; a poly-line, closed if its first place is its last; or one place, of points.
    std::vector<std::vector<SurfacePlace>> curves;
    bool all = false;  ///< a region that is the whole mesh: `faces` lists every face
    std::vector<Attribute> attributes;
    std::vector<Information> information;
    std::string note;  ///< what a transfer or a simplification had to do to it, if anything
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
    std::vector<std::string> notes;  ///< what reading or following a change of the mesh had to say, in words

    [[nodiscard]] const Annotation* find(int id) const;
    [[nodiscard]] Annotation* find(int id);
};

std::string to_string(AnnotationType type);
/// As messages name it: "annotation 3 ('spout')".
std::string name_of(const Annotation& annotation);

/// The annotation that stands for the whole object: a region with `all`. Made in front of the others if there is none, with
/// the class as its tag ("object" if the class is not known), and a free id. The object's own attributes (total height, site of
/// excavation ...) belong to it.
Annotation& ensure_root(AnnotationSet& set, const Mesh& mesh);

/// A fresh id: one more than the largest, 0 in an empty set.
int free_id(const AnnotationSet& set);

/// The vertices an annotation touches, ascending, without repeats: its points, the vertices of its poly-lines or the corners
/// of its faces.
std::vector<Index> touched_vertices(const Mesh& mesh, const Annotation& annotation);

/// The vertices that a measure names: its points and those of its repeats.
std::vector<Index> pins_of(const Measure& measure);

/// What measures and descriptors have in common; nothing of a word.
struct Figures {
    std::vector<double> values;  ///< of a measure: one, or none
    std::string unit;
    bool stale = false;
};
Figures figures_of(const Attribute& attribute);

/// One flag per face of a region.
std::vector<bool> face_flags(const Mesh& mesh, const std::vector<Index>& faces);
/// Of faces, in their order.
double area_of(const Mesh& mesh, const std::vector<Index>& faces);
/// The faces whose flag is set, ascending.
std::vector<Index> flagged(const std::vector<bool>& flags);

}  // namespace ostraka
