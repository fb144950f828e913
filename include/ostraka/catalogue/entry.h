// Catalogue entry of one object: everything that a printed catalogue shows and says about the object.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/options.h"
#include "ostraka/files/json.h"
#include "ostraka/mesh/mesh.h"

#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace ostraka {

/// How the catalogue draws an object; decided from its shape.
enum class CatalogueKind {
    vessel,     ///< a surface of revolution whose wall goes all around and whose rim is whole
    rim,        ///< a sherd with an axis and a part of the rim
    base,       ///< a sherd with an axis and a part of the base, without rim
    wall,       ///< a sherd with an axis, without rim and base
    turned,     ///< a body of revolution that is not hollow, such as a spindle whorl
    object,     ///< an object without an axis of revolution, such as a figurine
    landmarks,  ///< an object with landmarks, such as a skull
    unreadable  ///< an object whose files could not be read
};
/// The kind as the catalogue names it: "whole vessel", "rim sherd", ...
std::string to_string(CatalogueKind kind);

/// A picture of the object in parallel projection. Lengths are in millimetres of the object.
struct CatalogueView {
    std::string name;              ///< what is shown: "front", "outside", ...
    std::string jpeg;              ///< JPEG file of the shaded object on white; empty: no picture
    double left = 0, low = 0;      ///< position of the picture's lower left corner
    double width = 0, height = 0;  ///< size of the picture
    /// Extent of the object in the view.
    double object_left = 0, object_right = 0, object_low = 0, object_high = 0;
    std::vector<std::vector<Eigen::Vector2d>> outline;  ///< closed curves of the silhouette
    /// Landmarks that are visible in the view.
    struct Mark {
        std::size_t number = 0;  ///< number of the landmark, from 1
        Eigen::Vector2d place{0, 0};
    };
    std::vector<Mark> marks;
};

/// A diameter with its uncertainty, in millimetres.
struct CatalogueDiameter {
    std::string name;          ///< what it is the diameter of: "rim diameter", ...; empty: there is no diameter
    double value = 0;          ///< the diameter
    double low = 0, high = 0;  ///< 95 % interval; if the circle is whole, the range of the diameters in all directions
    bool is_range = false;     ///< true: low and high are the smallest and the largest diameter of a whole circle
    double share = 0;          ///< preserved share of the circle, 0 to 1
    double height = 0;         ///< height of the circle above the lowest point
    /// False: the interval is wider than the options allow, so that the diameter is reported as unknown and not drawn.
    bool known = false;
};

/// The drawing of a vessel or a sherd about its axis. x is the distance from the axis, y the height above the lowest point, in
/// millimetres. The section lies at negative x; a drawing with the section on the right is reflected, except for the outside
/// view, of which then the left half is shown.
struct CatalogueDrawing {
    std::vector<std::vector<Eigen::Vector2d>> section;  ///< closed contours of the wall's section (even-odd rule)
    std::vector<std::vector<Eigen::Vector2d>> open;     ///< open contours of the section: where the scan has no surface
    std::vector<std::vector<Eigen::Vector2d>> breaks;   ///< parts of the contours that lie on fractures
    CatalogueView outside;                              ///< the object from outside, in the place where it belongs about the axis
    /// Outer profile, mirrored to positive x and ascending: the outline of the vessel where it is reconstructed; empty for a
    /// whole vessel.
    std::vector<Eigen::Vector2d> reconstructed;
    /// A horizontal line across the outside view, from the axis to `radius`.
    struct Line {
        enum class Type { rim, foot, edge, rib } type = Type::edge;  ///< edge: the profile bends; rib: a rib or a groove
        double height = 0, radius = 0;
        double from = 0, to = 0;  ///< range of distances from the axis, in the view, in which the line lies on preserved surface
    };
    std::vector<Line> lines;
    double high = 0;           ///< height of the highest point
    double section_reach = 0;  ///< largest distance of the section from the axis
    double section_near = 0;   ///< smallest distance of the section from the axis
};

/// Numbers with unknown values as NaN.
inline constexpr double unknown_number = std::numeric_limits<double>::quiet_NaN();

/// The catalogue entry of one object. Lengths are in millimetres, volumes in litres, weights in grams.
struct CatalogueEntry {
    std::string name;  ///< name of the object
    CatalogueKind kind = CatalogueKind::object;
    std::string problem;        ///< why the object could not be read; empty otherwise
    std::string unit;           ///< unit of the object's coordinates
    bool unit_assumed = false;  ///< true: neither the files nor the caller state the unit
    std::size_t vertices = 0, faces = 0;

    CatalogueDiameter diameter;      ///< of the rim, else of the base, else the largest diameter of the wall
    double height = unknown_number;  ///< height of the object, or of what is left of it
    double width = unknown_number, depth = unknown_number;                   ///< horizontal extents of an object without axis
    double thickness = unknown_number;                                       ///< median thickness of the wall
    double thickness_low = unknown_number, thickness_high = unknown_number;  ///< 5 % and 95 % quantiles of the thickness
    double capacity = unknown_number;                                        ///< capacity to the rim, litres
    double capacity_error = unknown_number;                                  ///< half the 95 % interval of the capacity, litres
    double volume = unknown_number;                                          ///< volume of the body, cm^3
    double weight = unknown_number;                                          ///< weight for the stated density
    std::vector<std::string> unknown;  ///< what cannot be known, with the reason, each a clause

    CatalogueDrawing drawing;          ///< drawing about the axis; empty for objects without an axis
    std::vector<CatalogueView> views;  ///< shaded views

    std::vector<std::string> landmarks;  ///< names of the landmarks, in the order of their numbers
    /// Annotations of parts: tag, and measures as text.
    std::vector<std::pair<std::string, std::string>> annotations;
    std::vector<std::pair<std::string, std::string>> state;       ///< statements about the whole object: name, text
    std::vector<std::pair<std::string, std::string>> provenance;  ///< title, creator, identifier, ...: name, text
    std::vector<std::string> notes;                               ///< remarks on how the entry was made

    /// True if the entry has a drawing about an axis.
    [[nodiscard]] bool has_axis() const;
};

/// What an entry is made from.
struct CatalogueSubject {
    std::string name;
    TriangleSoup soup;                                                     ///< triangles of the object
    std::string unit;                                                      ///< unit of the coordinates; empty: unknown
    const AnnotationSet* annotations = nullptr;                            ///< annotations of the mesh made from `soup`, or null
    std::vector<std::pair<std::string, std::array<double, 3>>> landmarks;  ///< names and places in the space of the mesh
    std::vector<std::string> notes;                                        ///< remarks of the readers
};

struct CatalogueOptions {
    std::string unit;        ///< unit of objects that state none; empty: millimetres are assumed, with a note
    double max_error = 0.1;  ///< largest half width of the interval of a diameter that is drawn, as a share of the diameter
    double density = 0;      ///< density of the material, g/cm^3; 0: unknown, no weight is given
    /// The outside view: shaded, or only lines.
    enum class Outside { shaded, lines } outside = Outside::shaded;
    bool views = true;           ///< with shaded views beside the drawing
    bool section_right = false;  ///< the drawing has the section on the right: the outside view fills its left half
    int pixels = 900;            ///< pixels along the longer side of the main picture

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Makes the entry of an object. Vessels and sherds are placed upright about their axis of revolution (`catalogue_axis`): the rim
/// is at the top if one of the two ends of the wall is level. Whether the wall goes all around follows from the angles at which
/// the wall is met at 240 heights, not from whether contours close. Other objects are shown as they stand (annotated upward
/// direction, else z). The result does not depend on the number of threads. Throws Error (input) for a soup without triangles,
/// and Error (usage) for an unknown unit.
CatalogueEntry catalogue_entry(const CatalogueSubject& subject, const CatalogueOptions& options = {});

/// The entry as JSON and back, for results that persist between runs. `entry_from_json` accepts what `to_json` wrote.
Json to_json(const CatalogueEntry& entry);
CatalogueEntry entry_from_json(const JsonValue& document);

}  // namespace ostraka
