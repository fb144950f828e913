// Annotations: statements about parts of a mesh (thesis, section 2.2: A = (I, S, P)).
#pragma once

#include "ostraka/files/json.h"
#include "ostraka/geom/surface_point.h"
#include "ostraka/mesh/mesh.h"

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace ostraka {

/// A measure with the pins (picked vertices) that define the measure (Appendix B.1).
struct Measure {
    std::string tool;  ///< "ruler", "tape" or "bounding"
    /// Pins as vertex indices: two for a ruler, two or more for a tape, the two extreme vertices for bounding.
    std::vector<Index> points;
    /// Exact position of each pin of `points`, possibly inside a face; empty: the pins are at the vertices.
    std::vector<SurfacePoint> locations;
    std::optional<std::array<double, 3>> direction;  ///< direction along which a bounding measure is taken
    /// Measured value in `unit` (mean over the repeated pickings); none if not yet computed.
    std::optional<double> value;
    std::string unit;    ///< unit of `value`
    bool stale = false;  ///< true: the mesh or the pins changed and the value was not recomputed
    /// Tape only: true if the tape follows the exact geodesic across faces ("geodesic": "exact"), false if it follows edges.
    bool exact = false;
    /// Repeated pickings of the end points of the measure; each picking has one vertex per entry of `points`.
    std::vector<std::vector<Index>> repeats = {};
    /// Standard deviation of `value` over the pickings, in `unit`; none if unknown.
    std::optional<double> uncertainty = std::nullopt;
    bool operator==(const Measure&) const = default;
};

/// A computed quantity of a part that is not a measure between pins: area, curvature map, thickness ...
struct Descriptor {
    std::vector<double> values;  ///< the numbers; empty if `file` is given
    bool is_list = false;        ///< true: `values` is written as a list even if there is only one value
    /// File that holds the values: a map (array: .npy, .txt) or an axis (.json); path relative to the annotation file.
    std::string file;
    std::string unit;         ///< unit of `values`
    bool stale = false;       ///< true: the mesh or the annotation changed and the values were not recomputed
    std::string sha256 = {};  ///< checksum of the contents of `file`; empty: unknown
    bool operator==(const Descriptor&) const = default;
};

/// The text of a semantic attribute.
struct Note {
    std::string text;    ///< the statement, in words
    std::string origin;  ///< derivation of an inferred statement, e.g. the rule and its inputs; empty: a person's statement
    bool operator==(const Note&) const = default;
};

/// A named attribute of an annotation. Its value is a text (semantic attribute), a measure or a descriptor.
struct Attribute {
    int id = 0;                                     ///< unique among the attributes of the annotation
    std::string name;                               ///< name of the attribute
    std::variant<Note, Measure, Descriptor> value;  ///< the value; its alternative is the type of the attribute

    [[nodiscard]] const Note* note() const { return std::get_if<Note>(&value); }                    ///< null if not semantic
    [[nodiscard]] Note* note() { return std::get_if<Note>(&value); }                                ///< null if not semantic
    [[nodiscard]] const Measure* measure() const { return std::get_if<Measure>(&value); }           ///< null if not a measure
    [[nodiscard]] Measure* measure() { return std::get_if<Measure>(&value); }                       ///< null if not a measure
    [[nodiscard]] const Descriptor* descriptor() const { return std::get_if<Descriptor>(&value); }  ///< null if no descriptor
    [[nodiscard]] Descriptor* descriptor() { return std::get_if<Descriptor>(&value); }              ///< null if no descriptor
};

/// Additional information of an annotation (section 2.2.1): a text, a link or a file, with a checksum if the file is local.
struct Information {
    enum class Kind { text, image, link, file } kind = Kind::text;
    std::string value;   ///< the text, or the location of the image, link or file: URL or path relative to the annotation file
    std::string title;   ///< title for display; may be left empty
    std::string sha256;  ///< checksum of the contents of a local image or file; empty: unknown
    bool operator==(const Information&) const = default;
    /// True for an image or a file whose location is not a URL.
    [[nodiscard]] bool is_local() const;
};
std::string to_string(Information::Kind kind);

/// The kind of elements that an annotation selects on the mesh.
enum class AnnotationType { point, line, region };

/// Colour (grey) of annotations that cover the whole object and thus distinguish no part.
inline constexpr std::array<int, 3> neutral_colour{190, 190, 190};

/// A named part of a mesh. The part is selected by indices of mesh elements, in exactly one of `points`, `polylines` and
/// `faces`. A free annotation also has curves of its own, which need not follow the edges of the mesh; its indices then select
/// the elements nearest to the curves (curves.h).
struct Annotation {
    int id = 0;                                  ///< unique among the annotations of the set
    std::string tag;                             ///< name of the annotated part
    std::array<int, 3> colour = neutral_colour;  ///< red, green, blue, 0 to 255
    AnnotationType type = AnnotationType::region;
    std::vector<Index> points;  ///< point annotation: vertices, in the order given
    /// Line annotation: vertices of each poly-line, consecutive ones connected by an edge; closed if the first vertex is repeated
    /// at the end.
    std::vector<std::vector<Index>> polylines;
    std::vector<Index> faces;  ///< region: indices of its faces, ascending, without repeats
    /// Curves of a free annotation, each a list of stored points (stored_point); consecutive points lie in a common face. Curves
    /// of a region are outlines with the interior to the left, closed (the first point is repeated) or from border to border of
    /// the mesh. Curves of a line are poly-lines, closed if the first point is repeated. Curves of a point annotation have one
    /// point each.
    std::vector<std::vector<SurfacePoint>> curves;
    bool all = false;                      ///< true: the region is the whole mesh, and `faces` lists every face
    std::vector<Attribute> attributes;     ///< semantic attributes, measures and descriptors of the annotation
    std::vector<Information> information;  ///< texts, links and files attached to the annotation
    std::string note;                      ///< changes that a transfer or a simplification made to the annotation, if any
};

/// All annotations of one mesh.
struct AnnotationSet {
    AnnotationSet() = default;
    AnnotationSet(const AnnotationSet& other);
    AnnotationSet& operator=(const AnnotationSet& other);
    AnnotationSet(AnnotationSet&&) = default;
    AnnotationSet& operator=(AnnotationSet&&) = default;

    std::string object_class;                 ///< class of the object ("class" in the file); empty if unknown
    std::string unit;                         ///< unit of the mesh's coordinates; empty if unknown
    std::optional<std::array<double, 3>> up;  ///< upward direction of the object; none if unknown
    std::vector<Annotation> annotations;      ///< the annotations, in the order of the file
    Json provenance;                          ///< provenance as read from the file; null if the file has none
    std::vector<std::string> notes;           ///< remarks by the reader or by functions that adapted the set to a changed mesh

    [[nodiscard]] const Annotation* find(int id) const;  ///< the annotation with this id; null if there is none
    [[nodiscard]] Annotation* find(int id);              ///< the annotation with this id; null if there is none
};

std::string to_string(AnnotationType type);
/// The annotation as named in messages: "annotation 3 ('spout')".
std::string name_of(const Annotation& annotation);

/// The annotation of the whole object: a region with `all`. If the set has no such annotation, one is inserted as the first
/// annotation, with the class as its tag ("object" if the class is unknown) and a free id. The attributes of this annotation are
/// the attributes of the object itself (total height, site of excavation and so on).
Annotation& ensure_root(AnnotationSet& set, const Mesh& mesh);

/// An annotation id that the set does not use: one more than the largest id, or 0 for an empty set.
int free_id(const AnnotationSet& set);

/// The vertices of an annotation, ascending, without repeats: its points, the vertices of its poly-lines or the corners of its
/// faces.
std::vector<Index> touched_vertices(const Mesh& mesh, const Annotation& annotation);

/// The vertices that a measure refers to: its pins, and the pins of its repeated pickings.
std::vector<Index> pins_of(const Measure& measure);
/// The pins of the attribute's measure; empty if the attribute is not a measure.
std::vector<Index> pins_of(const Attribute& attribute);

/// Values of a measure or descriptor attribute; empty for a semantic attribute.
struct Figures {
    std::vector<double> values;  ///< values of the attribute; a measure has at most one
    std::string unit;            ///< unit of `values`
    bool stale = false;          ///< true: the mesh or the pins changed and the values were not recomputed
};
/// The numbers of a measure or descriptor attribute.
Figures attribute_values(const Attribute& attribute);

/// For each face of the mesh: true if the face is listed in `faces`.
std::vector<bool> face_flags(const Mesh& mesh, const std::vector<Index>& faces);
/// Total area of the faces, added up in the given order.
double area_of(const Mesh& mesh, const std::vector<Index>& faces);
/// The faces whose flag is set, ascending.
std::vector<Index> flagged(const std::vector<bool>& flags);

}  // namespace ostraka
