// Selection expressions of recipes: one JSON object each, nested by set operations.
#pragma once

#include "select/camera_reader.h"

#include "ostraka/annotation/curves.h"
#include "ostraka/files/json.h"
#include "ostraka/geom/shortest_path.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/select/scalars.h"
#include "select/screen.h"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// Coordinate frame of a recipe's coordinates: the mesh's own, or relative to its bounding box (0 to 1 along each axis; lengths
/// in diagonals).
struct PlaceFrame {
    bool box = false;
};

/// Settings of a recipe for all its expressions.
struct Surroundings {
    const JsonValue* cameras = nullptr;  ///< named cameras
    PlaceFrame frame;                    ///< frame of the cameras
    std::array<double, 3> up{0, 0, 1};   ///< upward direction of cameras that give none
    Path folder;                         ///< folder that file names in expressions are relative to
};

/// Borders of a selection where they run through faces.
struct SelectionBorders {
    std::vector<SurfaceCurve> curves;                        ///< pieces in one face each, and legs of lassos
    std::map<std::string, std::vector<std::size_t>> lassos;  ///< curves of each lasso, by its JSON pointer in the recipe
};

/// A selection on the mesh cut along the selection's borders.
struct CutSelection {
    CutMesh cut;
    std::vector<bool> faces;  ///< selected faces of the cut mesh
};

/// A scalar per vertex, and the level at which a selection has its border.
struct SelectionLevel {
    std::vector<double> values;
    double level = 0;
    bool above = true;  ///< true: values inside are at least the level; false: at most
};

/// Evaluates expressions on one object, whose annotations are those made so far. All errors name the file and the JSON pointer.
class ExpressionEvaluator {
public:
    ExpressionEvaluator(AnnotatedMeshView object, const std::vector<std::int32_t>& face_labels, std::string where);
    /// Sets the cameras and frames; `surroundings.cameras` must outlive the evaluator.
    void look_from(const Surroundings& surroundings) { surroundings_ = surroundings; }

    std::vector<bool> faces(const JsonValue& expression, PlaceFrame frame, const std::string& at) const;
    std::vector<Index> vertices(const JsonValue& expression, PlaceFrame frame, const std::string& at) const;
    std::vector<std::vector<Index>> polylines(const JsonValue& expression, PlaceFrame frame, const std::string& at) const;

    /// The lines of an expression as geodesics.
    std::vector<std::vector<SurfacePoint>> curves(const JsonValue& expression, PlaceFrame frame, const std::string& at) const;

    /// True if part of the selection's border is a level of a field, which runs through the faces: for volumes, shapes drawn in
    /// pictures, thresholds on vertices, brushes, lassos along geodesics, growth by a distance, and regions with a free
    /// outline. All other selections are sets of faces.
    bool ends_at_levels(const JsonValue& expression, PlaceFrame frame, const std::string& at) const;

    /// Selects where borders of sets of faces run from now on: along the edges of the mesh, or (default) at isolines.
    void keep_face_sets(bool along_edges) { face_sets_along_edges_ = along_edges; }

    /// The faces of an expression on the mesh cut along the borders of the expression.
    CutSelection cut_selection(const JsonValue& expression, PlaceFrame frame, const std::string& at) const;

    /// Adds the curves along which the selection's borders cross faces: for volumes, pictures, thresholds, brushes and
    /// `level_of` straight pieces between exact points on edges, for lassos geodesics. Other selections have borders along
    /// edges and add nothing.
    void add_borders(const JsonValue& expression, PlaceFrame frame, const std::string& at, SelectionBorders& borders) const;
    /// From now on evaluates on the mesh of `whole` cut along these borders: each face lies on one side of them. All three
    /// arguments must outlive this object.
    void stand_on(const ExpressionEvaluator& whole, const CutMesh& cut, const SelectionBorders& borders) {
        whole_ = &whole, cut_ = &cut, borders_ = &borders;
    }

    /// A vertex given by its index or as the nearest to a point.
    Index vertex(const JsonValue& pick, PlaceFrame frame, const std::string& at) const;
    /// The frame that an object specifies, or else the surrounding one.
    static PlaceFrame frame_of(const JsonValue& object, PlaceFrame around);

private:
    Point point(const JsonValue& list, PlaceFrame frame, const std::string& at) const;
    Index face(const JsonValue& pick, PlaceFrame frame, const std::string& at) const;
    std::vector<Index> picks(const JsonValue& list, PlaceFrame frame, const std::string& at) const;
    std::function<bool(const Point&)> volume(const std::string& kind, const JsonValue& value, PlaceFrame frame,
                                             const std::string& at) const;
    /// The camera of an expression or pick, by name or given inline.
    [[nodiscard]] ScreenCamera camera(const JsonValue& owner, PlaceFrame frame, const std::string& at) const;
    /// The surface point at a pick given by a pixel.
    SurfaceHit seen(const JsonValue& pick, PlaceFrame frame, const std::string& at) const;
    ScreenArea screen_area(const std::string& kind, const JsonValue& value, const ScreenCamera& camera,
                           const std::string& at) const;
    /// Built at the first use.
    const SurfaceSearch& search(const std::string& at) const;
    /// Selections computed from scalars and distances: brush, threshold, segments, grow and shrink.
    [[nodiscard]] std::vector<bool> reckoned_faces(const std::string& kind, const JsonValue& value, PlaceFrame frame,
                                                   const std::string& at) const;
    [[nodiscard]] std::vector<Index> reckoned_vertices(const std::string& kind, const JsonValue& value, PlaceFrame frame,
                                                       const std::string& at) const;
    /// A length of the recipe in the mesh's unit.
    [[nodiscard]] double length(double value, PlaceFrame frame) const;
    /// The picked vertices that have faces.
    std::vector<Index> surface_picks(const JsonValue& list, PlaceFrame frame, const std::string& at) const;
    std::vector<Index> brush_centres(const JsonValue& value, PlaceFrame frame, const std::string& at) const;
    bool on_faces(const JsonValue& threshold, PlaceFrame frame, const std::string& at) const;
    /// The field and level at which a selection has its border. If something is grown or shrunk by a distance: the exact
    /// geodesic distance from its border, negative inside. For selections face by face (segments, labels, thresholds on faces,
    /// growth by rings), unless they keep to the edges: the selected share of the area around each vertex, with level one half,
    /// if any vertex reaches it. Null otherwise and for other kinds. Cached by the position in the recipe.
    const SelectionLevel* level_of(const JsonValue& expression, PlaceFrame frame, const std::string& at) const;
    std::vector<bool> faces_of_origin(const std::vector<bool>& whole) const;
    /// True if this lasso runs along the edges of the mesh, that is, has a metric.
    bool keeps_to_edges(const JsonValue& lasso) const;
    std::vector<bool> lassoed(const JsonValue& value, PlaceFrame frame, const std::string& at) const;
    ScalarMap scalar(const JsonValue& value, PlaceFrame frame, const std::string& at) const;
    const ScalarMap& thickness_map() const;
    ScalarRange interval(const JsonValue& value, const ScalarMap& map, const std::string& at) const;
    std::vector<bool> segments(const JsonValue& value, PlaceFrame frame, const std::string& at) const;
    bool by_distance(const JsonValue& value, const std::string& at) const;
    /// Calls `work` and adds the position in the recipe to its error messages about the mesh.
    void in_place(const std::string& at, const std::function<void()>& work) const;
    const Annotation& earlier(const JsonValue& id, AnnotationType type, const std::string& at) const;
    /// The kind of an expression and its value; fails for an expression with two kinds.
    std::pair<std::string, const JsonValue*> only_kind(const JsonValue& expression, const std::string& at) const;
    [[noreturn]] void fail(const std::string& at, const std::string& what, const std::string& remedy) const;

    bool face_sets_along_edges_ = false;
    const ExpressionEvaluator* whole_ = nullptr;  ///< evaluator of the uncut mesh, if this one is on a cut mesh
    const CutMesh* cut_ = nullptr;
    const SelectionBorders* borders_ = nullptr;
    mutable ScalarMap uncut_;  ///< last values requested, on the uncut mesh
    const Mesh& mesh_;
    const std::vector<std::int32_t>& face_labels_;
    const AnnotationSet& set_;
    std::string where_;
    CGAL::Bbox_3 bounds_;
    Surroundings surroundings_;
    mutable std::optional<SurfaceSearch> search_;
    mutable std::map<std::string, ScreenCamera> cameras_;         ///< named cameras
    mutable std::map<std::string, ScalarMap> maps_;               ///< computed maps
    mutable std::map<std::string, std::vector<Index>> segments_;  ///< computed segments
    mutable std::map<std::string, std::optional<SelectionLevel>> levels_;
};

/// The kind of an expression (its member that is not "frame") and its value.
std::pair<std::string, const JsonValue*> kind_of(const JsonValue& expression);

/// The metric of a path or lasso.
PathMetric metric_of(const JsonValue& value);

}  // namespace ostraka
