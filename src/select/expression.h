// Selection expressions of recipes: each expression is a JSON object, and set operations contain further expressions.
#pragma once

#include "select/camera_reader.h"

#include "ostraka/annotation/curves.h"
#include "ostraka/files/json.h"
#include "ostraka/geom/shortest_path.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/measure/surface_colour.h"
#include "ostraka/select/scalars.h"
#include "select/painted.h"
#include "select/screen.h"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// Coordinate system of a recipe's coordinates.
struct PlaceFrame {
    /// True: coordinates relative to the mesh's bounding box (0 to 1 along each axis), lengths in diagonals; false: the mesh's
    /// own.
    bool box = false;
};

/// Settings of a recipe that all its expressions share.
struct Surroundings {
    const JsonValue* cameras = nullptr;      ///< named cameras (JSON object); null: none
    PlaceFrame frame;                        ///< coordinate system of the cameras
    std::array<double, 3> up{0, 0, 1};       ///< upward direction for cameras that state none
    Path folder;                             ///< folder to which file names in expressions are relative
    const MeshExtras* attributes = nullptr;  ///< colours, texture and values of the mesh; null: none
};

/// Borders of a selection where they cross faces.
struct SelectionBorders {
    std::vector<SurfaceCurve> curves;  ///< curves across one face each, and legs of lassos
    /// From the JSON pointer of each lasso in the recipe to the indices of its curves.
    std::map<std::string, std::vector<std::size_t>> lassos;
};

/// A selection on the mesh that was cut along the selection's borders.
struct CutSelection {
    CutMesh cut;              ///< the cut mesh, and its relation to the original mesh
    std::vector<bool> faces;  ///< for each face of the cut mesh, whether it is selected
};

/// A scalar field, and the level at which a selection has its border.
struct SelectionLevel {
    std::vector<double> values;  ///< value of each vertex
    double level = 0;            ///< value at the border
    bool above = true;           ///< true: the selection is where values are at least the level; false: at most
};

/// Evaluates selection expressions on one object, whose annotations are those of earlier steps. Errors name the file and the JSON
/// pointer.
class ExpressionEvaluator {
public:
    ExpressionEvaluator(AnnotatedMeshView object, const std::vector<std::int32_t>& face_labels, std::string where);
    /// Sets the cameras and coordinate systems; `surroundings.cameras` must outlive the evaluator.
    void set_surroundings(const Surroundings& surroundings) { surroundings_ = surroundings; }

    /// Selected faces, vertices or lines of an expression; `at`: JSON pointer of the expression.
    std::vector<bool> faces(const JsonValue& expression, PlaceFrame frame, const std::string& at) const;
    std::vector<Index> vertices(const JsonValue& expression, PlaceFrame frame, const std::string& at) const;
    std::vector<std::vector<Index>> polylines(const JsonValue& expression, PlaceFrame frame, const std::string& at) const;

    /// The lines of an expression as geodesics on the surface.
    std::vector<std::vector<SurfacePoint>> curves(const JsonValue& expression, PlaceFrame frame, const std::string& at) const;

    /// True if part of the selection's border is a level of a field, which crosses the faces: for volumes, shapes drawn in
    /// pictures, thresholds on vertices, brushes, lassos along geodesics, growth by a distance, and regions with a free outline.
    /// All other selections are sets of faces.
    bool ends_at_levels(const JsonValue& expression, PlaceFrame frame, const std::string& at) const;

    /// From now on selects where borders of sets of faces run: along the edges of the mesh, or (default) at isolines of the
    /// selected share around each vertex.
    void keep_face_sets(bool along_edges) { face_sets_along_edges_ = along_edges; }

    /// The selection of an expression on the mesh cut along the borders of the selection.
    CutSelection cut_selection(const JsonValue& expression, PlaceFrame frame, const std::string& at) const;

    /// Adds the curves along which the selection's borders cross faces: for volumes, pictures, thresholds, brushes and `level_of`
    /// straight pieces between exact points on edges, for lassos geodesics. Other selections have borders along edges, for which
    /// no curve is added.
    void add_borders(const JsonValue& expression, PlaceFrame frame, const std::string& at, SelectionBorders& borders) const;
    /// From now on evaluates expressions on the mesh of `whole` cut along these borders, so that each face lies on one side of
    /// every border. All three arguments must outlive this object.
    void evaluate_on_cut(const ExpressionEvaluator& whole, const CutMesh& cut, const SelectionBorders& borders) {
        whole_ = &whole, cut_ = &cut, borders_ = &borders;
    }

    /// Index of a vertex that is given by its index or as the vertex nearest to a point.
    Index vertex(const JsonValue& pick, PlaceFrame frame, const std::string& at) const;
    /// The coordinate system that a JSON object states, or else `around`.
    static PlaceFrame frame_of(const JsonValue& object, PlaceFrame around);

private:
    Point point(const JsonValue& list, PlaceFrame frame, const std::string& at) const;  ///< position given by three numbers
    Index face(const JsonValue& pick, PlaceFrame frame, const std::string& at) const;   ///< index of a picked face
    /// Indices of picked vertices.
    std::vector<Index> picks(const JsonValue& list, PlaceFrame frame, const std::string& at) const;
    std::function<bool(const Point&)> volume(const std::string& kind, const JsonValue& value, PlaceFrame frame,
                                             const std::string& at) const;
    /// The camera of an expression or pick, given by name or inline.
    [[nodiscard]] ScreenCamera camera(const JsonValue& owner, PlaceFrame frame, const std::string& at) const;
    /// The surface point seen at the pixel of a pick.
    SurfaceHit seen(const JsonValue& pick, PlaceFrame frame, const std::string& at) const;
    /// Area of a picture given by a rectangle or polygon.
    ScreenArea screen_area(const std::string& kind, const JsonValue& value, const ScreenCamera& camera,
                           const std::string& at) const;
    /// Search tree of the mesh, built at the first use.
    const SurfaceSearch& search(const std::string& at) const;
    /// Faces selected by scalars and distances: brush, threshold, segments, grow and shrink.
    [[nodiscard]] std::vector<bool> field_selected_faces(const std::string& kind, const JsonValue& value, PlaceFrame frame,
                                                         const std::string& at) const;
    /// Vertices selected by scalars and distances: brush, threshold, grow and shrink.
    [[nodiscard]] std::vector<Index> field_selected_vertices(const std::string& kind, const JsonValue& value, PlaceFrame frame,
                                                             const std::string& at) const;
    /// Converts a length of the recipe to the mesh's unit.
    [[nodiscard]] double length(double value, PlaceFrame frame) const;
    /// Indices of the picked vertices; each must have a face.
    std::vector<Index> surface_picks(const JsonValue& list, PlaceFrame frame, const std::string& at) const;
    /// Vertices on which the brush is placed.
    std::vector<Index> brush_centres(const JsonValue& value, PlaceFrame frame, const std::string& at) const;
    /// Whether the threshold applies to values of faces.
    bool on_faces(const JsonValue& threshold, PlaceFrame frame, const std::string& at) const;
    /// The field and level at which a selection has its border. If a selection is grown or shrunk by a distance: the exact
    /// geodesic distance from its border, negative inside. For selections face by face (segments, labels, thresholds on faces,
    /// growth by rings), unless borders run along edges: the selected share of the area around each vertex, with level one half,
    /// if any vertex reaches one half. Null for all other selections. Cached by the JSON pointer.
    const SelectionLevel* level_of(const JsonValue& expression, PlaceFrame frame, const std::string& at) const;
    /// For each face of the cut mesh, the flag of the original face that contains it.
    std::vector<bool> faces_of_origin(const std::vector<bool>& whole) const;
    /// True if this lasso runs along the edges of the mesh, that is, if it states a metric.
    bool keeps_to_edges(const JsonValue& lasso) const;
    /// Faces on the seed's side of a lasso.
    std::vector<bool> lassoed(const JsonValue& value, PlaceFrame frame, const std::string& at) const;
    /// The faces that a lasso along the edges of the mesh encloses.
    std::vector<bool> faces_in_lasso(const JsonValue& value, PlaceFrame frame, const std::string& at) const;
    /// The faces that have one of the labels.
    std::vector<bool> labelled_faces(const JsonValue& labels, const std::string& at) const;
    /// Scalar map that an expression names.
    ScalarMap scalar(const JsonValue& value, PlaceFrame frame, const std::string& at) const;
    const ScalarMap& thickness_map() const;  ///< wall thickness, computed at the first use
    /// The painted figure that an expression describes, at the resolution of the image. Cached by the JSON pointer.
    const PaintedFigure& painted(const JsonValue& value, PlaceFrame frame, const std::string& at) const;
    /// The faces of a painted figure; on a cut mesh those on the inner side of its outline.
    std::vector<bool> painted_faces(const JsonValue& value, PlaceFrame frame, const std::string& at) const;
    /// The point of the surface that a pick names: a vertex by its index, the point nearest to a place, or what is seen at a
    /// pixel.
    SurfaceHit place_on_surface(const JsonValue& pick, PlaceFrame frame, const std::string& at) const;
    /// Throws Error (input) unless the mesh has colours.
    void need_colours(const std::string& at) const;
    /// For each vertex, the difference of its colour from the colour of an expression (CIEDE2000).
    ScalarMap colour_map(const JsonValue& colour, PlaceFrame frame, const std::string& at) const;
    /// The values of vertices or faces that the mesh file has under this name.
    ScalarMap file_values(const std::string& name, const std::string& at) const;
    /// Interval of a threshold, in the values of the map.
    ScalarRange interval(const JsonValue& value, const ScalarMap& map, const std::string& at) const;
    /// Faces of the chosen segments of similar thickness.
    std::vector<bool> segments(const JsonValue& value, PlaceFrame frame, const std::string& at) const;
    /// Whether a growth is given by a distance instead of a number of rings.
    bool by_distance(const JsonValue& value, const std::string& at) const;
    /// Calls `work`; adds the JSON pointer `at` to error messages about the mesh.
    void in_place(const std::string& at, const std::function<void()>& work) const;
    /// The annotation of an earlier step with this id and type; throws Error (input) if there is none.
    const Annotation& earlier(const JsonValue& id, AnnotationType type, const std::string& at) const;
    /// The kind of an expression and its value; throws Error (input) for an expression with two kinds.
    std::pair<std::string, const JsonValue*> only_kind(const JsonValue& expression, const std::string& at) const;
    /// Throws Error (input) for the place `at`.
    [[noreturn]] void fail(const std::string& at, const std::string& what, const std::string& remedy) const;

    bool face_sets_along_edges_ = false;  ///< see keep_face_sets
    /// Evaluator of the uncut mesh, if this evaluator works on a cut mesh; else null.
    const ExpressionEvaluator* whole_ = nullptr;
    const CutMesh* cut_ = nullptr;               ///< the cut mesh; null: not cut
    const SelectionBorders* borders_ = nullptr;  ///< borders along which the mesh was cut
    mutable ScalarMap uncut_;                    ///< last scalar values requested on the uncut mesh
    const Mesh& mesh_;
    const std::vector<std::int32_t>& face_labels_;  ///< label of each face
    const AnnotationSet& set_;
    std::string where_;
    CGAL::Bbox_3 bounds_;  ///< bounding box of the mesh
    Surroundings surroundings_;
    mutable std::optional<SurfaceSearch> search_;
    mutable std::map<std::string, ScreenCamera> cameras_;                  ///< from a name to the camera
    mutable std::map<std::string, ScalarMap> maps_;                        ///< from a JSON pointer to the computed scalar map
    mutable std::vector<Lab> lab_;                                         ///< colours of the vertices, read at the first use
    mutable std::shared_ptr<const TexelColours> texels_;                   ///< colours of the image, read at the first use
    mutable std::map<std::string, PaintedFigure> figures_;                 ///< from a JSON pointer to the figure
    mutable std::map<std::string, std::vector<Index>> segments_;           ///< from a JSON pointer to the segment of each face
    mutable std::map<std::string, std::optional<SelectionLevel>> levels_;  ///< from a JSON pointer to the result of `level_of`
};

/// The kind of an expression (the name of its member that is not "frame") and the value of this member.
std::pair<std::string, const JsonValue*> kind_of(const JsonValue& expression);

/// The metric that a path or lasso states.
PathMetric metric_of(const JsonValue& value);

}  // namespace ostraka
