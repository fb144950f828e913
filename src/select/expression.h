// Selection expressions of recipes (doc/recipes.md): what expression_reader.h reads from JSON and evaluator.h evaluates on a
// mesh.
#pragma once

#include "ostraka/files/file.h"
#include "ostraka/geom/shortest_path.h"
#include "ostraka/render/camera.h"
#include "ostraka/render/picture.h"
#include "ostraka/select/scalars.h"
#include "select/painted.h"
#include "select/screen.h"

#include <array>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

namespace ostraka {

/// Coordinate system of a recipe's coordinates.
struct PlaceFrame {
    /// True: coordinates relative to the mesh's bounding box (0 to 1 along each axis), lengths in diagonals; false: the mesh's
    /// own.
    bool box = false;
    bool operator==(const PlaceFrame&) const = default;
};

struct SelectionExpression;

namespace selection {

/// A position in space.
struct Position {
    std::array<double, 3> coordinates{};  ///< x, y, z
    PlaceFrame frame;                     ///< coordinate system
};

/// A distance, not negative.
struct Length {
    double value = 0;
    PlaceFrame frame;  ///< box: in diagonals of the bounding box; otherwise in the mesh's unit
};

/// View of the whole object, as `render` shows it.
struct FittedView {
    View view;        ///< view direction
    double zoom = 1;  ///< magnification; 1 shows the whole object
};

/// View from a given position.
struct EyeView {
    Position eye, target;         ///< position of the eye; point shown in the middle of the pane
    std::optional<double> angle;  ///< angle of view of the smaller side of the pane, degrees; none: `pixels_per_unit` counts
    double pixels_per_unit = 1;   ///< scale at the target, pixels per unit of length
};

/// A camera, with the picture in which elements are selected.
struct Camera {
    std::string at;                            ///< JSON pointer
    int width = 1200, height = 900;            ///< size of the picture, pixels
    PixelBox pane;                             ///< part of the picture in which the object is drawn
    std::optional<std::array<double, 3>> up;   ///< upward direction; none: that of the object
    bool perspective = false;                  ///< true: perspective projection; false: parallel projection
    std::variant<FittedView, EyeView> pose{};  ///< position and direction
};

/// What is visible at a pixel.
struct PixelPick {
    std::shared_ptr<const Camera> camera;  ///< camera of the picture; never null
    Pixel pixel{};                         ///< place in the picture
};

/// A picked vertex or face: its index, the one nearest to a position, or the one visible at a pixel.
struct Pick {
    std::variant<Index, Position, PixelPick> place;
    std::string at;  ///< JSON pointer
};

/// `all`: the whole mesh.
struct WholeMesh {};

/// `faces`: faces by their indices.
struct FaceList {
    std::vector<Index> faces;
};

/// `vertices`: these vertices, or a poly-line of consecutive vertices.
struct VertexPicks {
    std::vector<Pick> picks;
};

/// `nearest`: the vertex nearest to a position.
struct NearestVertex {
    Position position;
};

/// `box`: a volume with sides parallel to the axes.
struct Box {
    Position min, max;  ///< lowest and highest corner
};

/// `sphere`: the volume within a distance of a position.
struct Sphere {
    Position centre;
    double radius = 0;  ///< in the frame of `centre`
};

/// `halfspace`: the side of a plane to which the normal points.
struct Halfspace {
    Position point;                    ///< a point of the plane
    Vector normal{CGAL::NULL_VECTOR};  ///< of any length above 0
};

/// Elements whose position is in a volume.
using Volume = std::variant<Box, Sphere, Halfspace>;

/// `rectangle`: the part of a picture between two opposite corners.
struct Rectangle {
    Pixel from{}, to{};
};

/// `polygon`: the part of a picture within a closed polygon.
struct Polygon {
    std::vector<Pixel> points;  ///< corners in their order, three or more
};

/// Elements seen in a part of a picture.
struct DrawnArea {
    std::shared_ptr<const Camera> camera;  ///< camera of the picture; never null
    std::variant<Rectangle, Polygon> shape;
    bool visible_only = true;  ///< false: hidden elements are selected too
};

/// `brush`: elements within a geodesic distance of the picks.
struct Brush {
    std::vector<Pick> points;
    Length radius;
    bool stroke = false;  ///< true: of the path through the picks
};

/// Quantity of a threshold: the coordinate along a direction; in the box frame as a share of the mesh's extent.
struct CoordinateQuantity {
    Vector direction{CGAL::NULL_VECTOR};
};

/// Quantity of a threshold: the mean or Gaussian curvature.
struct CurvatureQuantity {
    bool mean = false;  ///< false: Gaussian
    double scale = 0;   ///< radius as a fraction of the diagonal; 0: the faces around a vertex
};

/// Quantity of a threshold: the wall thickness of each face.
struct ThicknessQuantity {};

/// Quantity of a threshold: the geodesic distance to the nearest pick.
struct DistanceQuantity {
    std::vector<Pick> from;
};

/// Quantity of a threshold: the colour difference (CIEDE2000) from a colour, or from the colour at a pick.
struct ColourQuantity {
    std::variant<Rgb, Pick> reference;
};

/// Quantity of a threshold: values that the mesh file has under this name.
struct NamedQuantity {
    std::string name;
};

/// Quantity of a threshold: values in a file.
struct MapQuantity {
    Path file;
    std::optional<bool> on_faces;  ///< true: one value per face; false: one per vertex; none: by the number of values
};

/// `threshold`: elements whose value of a quantity lies in an interval.
struct Threshold {
    std::variant<CoordinateQuantity, CurvatureQuantity, ThicknessQuantity, DistanceQuantity, ColourQuantity, NamedQuantity,
                 MapQuantity>
        quantity;
    std::string quantity_at;             ///< JSON pointer of the quantity
    PlaceFrame frame;                    ///< unit of the values
    std::optional<double> above, below;  ///< lower and upper bound, one of them at least
    bool quantiles = false;              ///< true: the bounds are shares of the area, 0 to 1
};

/// `painted`: a figure in the image of the mesh.
struct Painted {
    PaintedFigureQuery query;  ///< all but `places` and `smallest`
    std::vector<Pick> places;  ///< places in the figure
    Length smallest;           ///< see PaintedFigureQuery
};

/// `segments`: parts of similar thickness.
struct Segments {
    SegmentOptions options;
    std::variant<std::vector<Pick>, std::vector<Index>> parts;  ///< faces in the parts, or the numbers of the parts
};

/// `grow`, `shrink`: a selection enlarged or reduced.
struct Growth {
    std::unique_ptr<const SelectionExpression> of;  ///< never null
    bool larger = true;                             ///< true: grow; false: shrink
    std::variant<int, Length> extent;               ///< number of rings of neighbours, or geodesic distance
};

/// `path`: shortest paths from pick to pick.
struct SurfacePath {
    std::vector<Pick> points;
    bool closed = false;  ///< true: from the last pick back to the first
    PathMetric metric = PathMetric::euclidean;
};

/// `lasso`: the part that the closed path through the points cuts off around the seed.
struct Lasso {
    std::vector<Pick> points;
    Pick seed;  ///< a face
    PathMetric metric = PathMetric::euclidean;
};

/// `component`: the connected part of the mesh or of a selection that contains the seed.
struct Component {
    Pick seed;                                      ///< a face
    std::unique_ptr<const SelectionExpression> of;  ///< null: of the mesh
};

/// `labels`: faces with one of these labels.
struct LabelledFaces {
    std::set<std::int32_t> labels;
};

/// `annotation`: the elements of an annotation of an earlier step.
struct EarlierAnnotation {
    int id = 0;
};

enum class SetOperator { unite, intersect, subtract };  ///< how `union`, `intersection` and `difference` combine selections

/// `union`, `intersection`, `difference`: a combination of selections.
struct Combination {
    SetOperator combine = SetOperator::unite;
    std::vector<SelectionExpression> operands;  ///< one or more; two for a difference
};

/// `invert`: all other elements.
struct Complement {
    std::unique_ptr<const SelectionExpression> of;  ///< never null
};

}  // namespace selection

/// A selection on a mesh. Which elements it selects, faces, vertices or lines, depends on the annotation for which it is
/// evaluated.
struct SelectionExpression {
    using Kind =
        std::variant<selection::WholeMesh, selection::FaceList, selection::VertexPicks, selection::NearestVertex,
                     selection::Volume, selection::DrawnArea, selection::Brush, selection::Threshold, selection::Painted,
                     selection::Segments, selection::Growth, selection::SurfacePath, selection::Lasso, selection::Component,
                     selection::LabelledFaces, selection::EarlierAnnotation, selection::Combination, selection::Complement>;
    std::string at;  ///< JSON pointer of the member that names the kind, such as "/annotations/0/select/box"
    Kind kind;
};

}  // namespace ostraka
