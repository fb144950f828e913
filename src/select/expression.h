// Selection expressions of recipes: one JSON object each, nested by the set operations.
#pragma once

#include "camera_reader.h"

#include "ostraka/annotation/curves.h"
#include "ostraka/core/json.h"
#include "ostraka/geom/shortest_path.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/select/scalars.h"
#include "ostraka/select/screen.h"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// Where coordinates of a recipe lie: in the mesh's own coordinates, or between the corners of its box (0 to 1 along each axis;
/// lengths in diagonals).
struct PlaceFrame {
    bool box = false;
};

/// What a recipe says once for all its expressions.
struct Surroundings {
    const JsonValue* cameras = nullptr;  ///< named ones
    PlaceFrame frame;                    ///< of those
    std::array<double, 3> up{0, 0, 1};   ///< of cameras that do not say
    Path folder;                         ///< of the files that expressions name
};

/// Where the borders of a selection run through the faces.
struct SelectionBorders {
    std::vector<SurfaceCurve> curves;                        ///< pieces, each in one face, and legs of lassos
    std::map<std::string, std::vector<std::size_t>> lassos;  ///< by the place of the lasso in the recipe: its curves
};

/// A selection on the mesh cut along its borders.
struct CutSelection {
    CutMesh cut;
    std::vector<bool> faces;  ///< of it
};

/// Numbers at vertices, and the one at the border of a selection.
struct SelectionLevel {
    std::vector<double> values;
    double level = 0;
    bool above = true;  ///< inside the values are at least the level, or at most
};

/// Evaluates expressions on one mesh. `set` holds the annotations made so far. All errors name file and JSON pointer.
class ExpressionEvaluator {
public:
    ExpressionEvaluator(const Mesh& mesh, const std::vector<std::int32_t>& face_labels, const AnnotationSet& set,
                        std::string where);
    /// Named cameras; `surroundings.cameras` must outlive the evaluator.
    void look_from(const Surroundings& surroundings) { surroundings_ = surroundings; }

    std::vector<bool> faces(const JsonValue& expression, PlaceFrame frame, const std::string& at) const;
    std::vector<Index> vertices(const JsonValue& expression, PlaceFrame frame, const std::string& at) const;
    std::vector<std::vector<Index>> polylines(const JsonValue& expression, PlaceFrame frame, const std::string& at) const;

    /// The lines of an expression as geodesics.
    std::vector<std::vector<SurfacePlace>> curves(const JsonValue& expression, PlaceFrame frame, const std::string& at) const;

    /// Whether a part of the border of these faces is a level of a field, which runs through the faces: of volumes, of what is
    /// drawn on pictures, thresholds on vertices, brushes, lassos along geodesics, growth by a distance, and of regions that are
    /// free. All others are sets of faces.
    bool ends_at_levels(const JsonValue& expression, PlaceFrame frame, const std::string& at) const;

    /// From now on borders of sets of faces run along the edges of the mesh, or (as at first) at isolines.
    void keep_face_sets(bool along_edges) { face_sets_along_edges_ = along_edges; }

    /// The faces of an expression where its borders are, on the mesh cut along them.
    CutSelection cut_selection(const JsonValue& expression, PlaceFrame frame, const std::string& at) const;

    /// Adds the places at which the selection's borders cross faces: of volumes, pictures, thresholds, brushes and `level_of`
    /// straight pieces between the exact places on edges, of lassos geodesics. Others run along edges and add nothing.
    void add_borders(const JsonValue& expression, PlaceFrame frame, const std::string& at, SelectionBorders& borders) const;
    /// From now on answers for the mesh that `whole` is of, cut along these borders: each face lies on one side of them. All
    /// three must outlive it.
    void stand_on(const ExpressionEvaluator& whole, const CutMesh& cut, const SelectionBorders& borders) {
        whole_ = &whole, cut_ = &cut, borders_ = &borders;
    }

    /// A vertex given by index or as the one nearest to a point.
    Index vertex(const JsonValue& pick, PlaceFrame frame, const std::string& at) const;
    /// The frame an object asks for, or the one around it.
    static PlaceFrame frame_of(const JsonValue& object, PlaceFrame around);

private:
    Point point(const JsonValue& list, PlaceFrame frame, const std::string& at) const;
    Index face(const JsonValue& pick, PlaceFrame frame, const std::string& at) const;
    std::vector<Index> picks(const JsonValue& list, PlaceFrame frame, const std::string& at) const;
    std::function<bool(const Point&)> volume(const std::string& kind, const JsonValue& value, PlaceFrame frame,
                                             const std::string& at) const;
    /// The camera of an expression or pick, by name or in place.
    [[nodiscard]] ScreenCamera camera(const JsonValue& owner, PlaceFrame frame, const std::string& at) const;
    /// What a pick by pixel sees.
    SurfaceHit seen(const JsonValue& pick, PlaceFrame frame, const std::string& at) const;
    ScreenArea screen_area(const std::string& kind, const JsonValue& value, const ScreenCamera& camera,
                           const std::string& at) const;
    /// Built when the first ray is needed.
    const SurfaceSearch& search(const std::string& at) const;
    /// brush, threshold, segments, grow and shrink
    [[nodiscard]] std::vector<bool> reckoned_faces(const std::string& kind, const JsonValue& value, PlaceFrame frame,
                                                   const std::string& at) const;
    [[nodiscard]] std::vector<Index> reckoned_vertices(const std::string& kind, const JsonValue& value, PlaceFrame frame,
                                                       const std::string& at) const;
    /// A length of the recipe in the mesh's unit.
    [[nodiscard]] double length(double value, PlaceFrame frame) const;
    /// Picked vertices that have faces.
    std::vector<Index> surface_picks(const JsonValue& list, PlaceFrame frame, const std::string& at) const;
    std::vector<Index> brush_centres(const JsonValue& value, PlaceFrame frame, const std::string& at) const;
    bool on_faces(const JsonValue& threshold, PlaceFrame frame, const std::string& at) const;
    /// Of what is grown or shrunk by a distance: the exact geodesic distance from its border, below 0 inside. Of what is chosen
    /// face by face (segments, labels, thresholds on faces, growth by rings), unless that keeps to the edges: the share of the
    /// faces' area around each vertex that is, where a vertex has half; otherwise, and of other kinds, nothing. Kept by the
    /// place in the recipe.
    const SelectionLevel* level_of(const JsonValue& expression, PlaceFrame frame, const std::string& at) const;
    std::vector<bool> faces_of_origin(const std::vector<bool>& whole) const;
    /// Whether this lasso runs along the edges of the mesh, of which its metric speaks.
    bool keeps_to_edges(const JsonValue& lasso) const;
    std::vector<bool> lassoed(const JsonValue& value, PlaceFrame frame, const std::string& at) const;
    ScalarMap scalar(const JsonValue& value, PlaceFrame frame, const std::string& at) const;
    const ScalarMap& thickness_map() const;
    ScalarRange interval(const JsonValue& value, const ScalarMap& map, const std::string& at) const;
    std::vector<bool> segments(const JsonValue& value, PlaceFrame frame, const std::string& at) const;
    bool by_distance(const JsonValue& value, const std::string& at) const;
    /// Calls `work`; what it finds wrong with the mesh is said with the place in the recipe.
    void in_place(const std::string& at, const std::function<void()>& work) const;
    const Annotation& earlier(const JsonValue& id, AnnotationType type, const std::string& at) const;
    /// The kind and its value; an expression of two kinds is refused.
    std::pair<std::string, const JsonValue*> only_kind(const JsonValue& expression, const std::string& at) const;
    [[noreturn]] void fail(const std::string& at, const std::string& what, const std::string& remedy) const;

    bool face_sets_along_edges_ = false;
    const ExpressionEvaluator* whole_ = nullptr;  ///< of the mesh that was cut, if this one is
    const CutMesh* cut_ = nullptr;
    const SelectionBorders* borders_ = nullptr;
    mutable ScalarMap uncut_;  ///< the values asked for last, as they are on that mesh
    const Mesh& mesh_;
    const std::vector<std::int32_t>& face_labels_;
    const AnnotationSet& set_;
    std::string where_;
    CGAL::Bbox_3 bounds_;
    Surroundings surroundings_;
    mutable std::optional<SurfaceSearch> search_;
    mutable std::map<std::string, ScreenCamera> cameras_;         ///< those with a name
    mutable std::map<std::string, ScalarMap> maps_;               ///< computed ones
    mutable std::map<std::string, std::vector<Index>> segments_;  ///< likewise
    mutable std::map<std::string, std::optional<SelectionLevel>> levels_;
};

/// The kind of an expression (its member that is not "frame") and its value.
std::pair<std::string, const JsonValue*> kind_of(const JsonValue& expression);

/// The metric of a path or lasso.
PathMetric metric_of(const JsonValue& value);

}  // namespace ostraka
