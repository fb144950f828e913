// Evaluates selection expressions of recipes on a mesh.
#pragma once

#include "ostraka/annotation/curves.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/measure/surface_colour.h"
#include "select/expression.h"
#include "select/screen_camera.h"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// Properties of the object that selections use.
struct Surroundings {
    std::array<double, 3> up{0, 0, 1};       ///< upward direction for cameras that state none
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
/// pointer. In all functions `at` is the JSON pointer of the argument before it.
class ExpressionEvaluator {
public:
    ExpressionEvaluator(AnnotatedMeshView object, const std::vector<std::int32_t>& face_labels, std::string where);
    void set_surroundings(const Surroundings& surroundings) { surroundings_ = surroundings; }

    /// Selected faces, vertices or lines of an expression.
    std::vector<bool> faces(const SelectionExpression& expression) const;
    std::vector<Index> vertices(const SelectionExpression& expression) const;
    std::vector<std::vector<Index>> polylines(const SelectionExpression& expression) const;

    /// The lines of an expression as geodesics on the surface.
    std::vector<std::vector<SurfacePoint>> curves(const SelectionExpression& expression) const;

    /// True if part of the selection's border is a level of a field, which crosses the faces: for volumes, shapes drawn in
    /// pictures, thresholds on vertices, brushes, lassos along geodesics, growth by a distance, and regions with a free outline.
    /// All other selections are sets of faces.
    bool ends_at_levels(const SelectionExpression& expression) const;

    /// From now on selects where borders of sets of faces run: along the edges of the mesh, or (default) at isolines of the
    /// selected share around each vertex.
    void keep_face_sets(bool along_edges) { face_sets_along_edges_ = along_edges; }

    /// The selection of an expression on the mesh cut along the borders of the selection.
    CutSelection cut_selection(const SelectionExpression& expression) const;

    /// Index of a vertex that is given by its index, as the vertex nearest to a position, or by a pixel.
    Index vertex(const selection::Pick& pick) const;

private:
    /// Evaluates expressions on the mesh of `whole` cut along these borders, so that each face lies on one side of every border.
    /// All arguments must outlive this object.
    ExpressionEvaluator(const ExpressionEvaluator& whole, const CutMesh& cut, const std::vector<std::int32_t>& face_labels,
                        const SelectionBorders& borders);

    // Picks and positions (evaluator.cpp, evaluator_screen.cpp).
    Point point(const selection::Position& position, const std::string& at) const;
    Index face(const selection::Pick& pick) const;                             ///< index of a picked face
    Index checked_face(Index face, const std::string& at) const;               ///< throws Error (input) for an index out of range
    std::vector<Index> picks(const std::vector<selection::Pick>& list) const;  ///< indices of picked vertices
    /// Indices of the picked vertices; each must have a face.
    std::vector<Index> surface_picks(const std::vector<selection::Pick>& list) const;
    /// The point of the surface that a pick names: a vertex by its index, the point nearest to a position, or what is seen at a
    /// pixel.
    SurfaceHit place_on_surface(const selection::Pick& pick) const;
    /// The surface point seen at the pixel of a pick.
    SurfaceHit seen(const selection::PixelPick& pick, const std::string& at) const;
    const ScreenCamera& camera(const selection::Camera& description) const;
    /// The part of a picture in which a rectangle or polygon is drawn.
    ScreenArea screen_area(const selection::DrawnArea& drawn, const std::string& at) const;
    /// Search tree for visibility; null if hidden elements are selected too.
    const SurfaceSearch* visibility(const selection::DrawnArea& drawn, const std::string& at) const;
    /// Search tree of the mesh, built at the first use.
    const SurfaceSearch& search(const std::string& at) const;
    /// Converts a length of the recipe to the mesh's unit.
    [[nodiscard]] double length(const selection::Length& length) const;
    std::function<bool(const Point&)> volume(const selection::Volume& volume, const std::string& at) const;
    /// The annotation of an earlier step with this type; throws Error (input) if there is none.
    const Annotation& earlier(const selection::EarlierAnnotation& annotation, AnnotationType type, const std::string& at) const;

    // Faces and vertices by their places and sets (evaluator.cpp).
    std::vector<bool> listed_faces(const selection::FaceList& list, const std::string& at) const;
    std::vector<bool> lasso_faces(const selection::Lasso& lasso, const std::string& at) const;
    /// Faces on the seed's side of a lasso, on the cut mesh.
    std::vector<bool> lassoed(const selection::Lasso& lasso, const std::string& at) const;
    std::vector<bool> component_faces(const selection::Component& component) const;
    std::vector<bool> labelled_faces(const selection::LabelledFaces& labelled, const std::string& at) const;
    std::vector<bool> annotated_faces(const selection::EarlierAnnotation& annotation, const std::string& at) const;
    std::vector<bool> combined_faces(const selection::Combination& combination) const;
    std::vector<Index> combined_vertices(const selection::Combination& combination) const;
    std::vector<Index> complement_vertices(const selection::Complement& complement) const;

    // Faces and vertices by scalars and distances (evaluator_fields.cpp).
    std::vector<bool> brush_faces(const selection::Brush& brush, const std::string& at) const;
    std::vector<bool> threshold_faces(const selection::Threshold& threshold, const std::string& at) const;
    std::vector<Index> threshold_vertices(const selection::Threshold& threshold, const std::string& at) const;
    std::vector<bool> segment_faces(const selection::Segments& segments, const std::string& at) const;
    std::vector<bool> growth_faces(const selection::Growth& growth) const;
    std::vector<Index> growth_vertices(const selection::Growth& growth, const std::string& at) const;
    /// The faces of a painted figure; on a cut mesh those on the inner side of its outline.
    std::vector<bool> painted_faces(const selection::Painted& painted, const std::string& at) const;
    /// Vertices on which the brush is placed.
    std::vector<Index> brush_centres(const selection::Brush& brush, const std::string& at) const;
    /// The painted figure that an expression describes, at the resolution of the image. Cached by the JSON pointer.
    const PaintedFigure& painted(const selection::Painted& description, const std::string& at) const;
    /// Values of the quantity of a threshold.
    ScalarMap scalar(const selection::Threshold& threshold, const std::string& at) const;
    ScalarMap values_of(const selection::CoordinateQuantity& quantity, const selection::Threshold& threshold) const;
    ScalarMap values_of(const selection::CurvatureQuantity& quantity, const selection::Threshold& threshold) const;
    ScalarMap values_of(const selection::ThicknessQuantity& quantity, const selection::Threshold& threshold) const;
    ScalarMap values_of(const selection::DistanceQuantity& quantity, const selection::Threshold& threshold) const;
    ScalarMap values_of(const selection::ColourQuantity& quantity, const selection::Threshold& threshold) const;
    ScalarMap values_of(const selection::NamedQuantity& quantity, const selection::Threshold& threshold) const;
    ScalarMap values_of(const selection::MapQuantity& quantity, const selection::Threshold& threshold) const;
    const ScalarMap& thickness_map() const;  ///< wall thickness, computed at the first use
    /// Interval of a threshold, in the values of the map.
    ScalarRange interval(const selection::Threshold& threshold, const ScalarMap& map, const std::string& at) const;
    /// Whether the threshold applies to values of faces.
    bool on_faces(const selection::Threshold& threshold, const std::string& at) const;
    /// Throws Error (input) unless the mesh has colours.
    void need_colours(const std::string& at) const;

    // Borders through the faces (evaluator_borders.cpp).
    /// Adds the curves along which the selection's borders cross faces: for volumes, pictures, thresholds, brushes and `level_of`
    /// straight pieces between exact points on edges, for lassos geodesics. Other selections have borders along edges, for which
    /// no curve is added.
    void add_borders(const SelectionExpression& expression, SelectionBorders& borders) const;
    void add_volume(const selection::Volume& volume, const std::string& at, SelectionBorders& borders) const;
    void add_drawn(const selection::DrawnArea& drawn, const std::string& at, SelectionBorders& borders) const;
    void add_threshold(const selection::Threshold& threshold, const std::string& at, SelectionBorders& borders) const;
    void add_lasso(const SelectionExpression& expression, const selection::Lasso& lasso, SelectionBorders& borders) const;
    /// The field and level at which a selection has its border. If a selection is grown or shrunk by a distance: the exact
    /// geodesic distance from its border, negative inside. For selections face by face (segments, labels, thresholds on faces,
    /// growth by rings), unless borders run along edges: the selected share of the area around each vertex, with level one half,
    /// if any vertex reaches one half. Null for all other selections. Cached by the JSON pointer.
    const SelectionLevel* level_of(const SelectionExpression& expression) const;
    std::optional<SelectionLevel> distance_level(const selection::Growth& growth, const selection::Length& distance) const;
    std::optional<SelectionLevel> share_level(const SelectionExpression& expression) const;
    /// Faces of the cut mesh on the selected side of a level.
    std::vector<bool> faces_at_level(const SelectionLevel& level) const;
    /// True if the borders of a selection without a level (`level_of`) run along the edges of the mesh.
    bool keeps_to_edges(const SelectionExpression& expression) const;
    /// True if this lasso runs along the edges of the mesh, that is, if it states a metric.
    bool keeps_to_edges(const selection::Lasso& lasso) const;

    /// Calls `work`; adds the JSON pointer `at` to error messages about the mesh.
    void in_place(const std::string& at, const std::function<void()>& work) const;
    /// Throws Error (input) for the place `at`.
    [[noreturn]] void fail(const std::string& at, const std::string& what, const std::string& remedy) const;
    /// The file and the place `at`, for errors of other functions.
    [[nodiscard]] std::string location(const std::string& at) const { return where_ + ", at " + at; }

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
    mutable std::map<std::string, ScreenCamera> cameras_;                  ///< from a JSON pointer to the camera
    mutable std::map<std::string, ScalarMap> maps_;                        ///< from a key of its options to the scalar map
    mutable std::vector<Lab> lab_;                                         ///< colours of the vertices, read at the first use
    mutable std::shared_ptr<const TexelColours> texels_;                   ///< colours of the image, read at the first use
    mutable std::map<std::string, PaintedFigure> figures_;                 ///< from a JSON pointer to the figure
    mutable std::map<std::string, std::vector<Index>> segments_;           ///< from a key of the options to each face's segment
    mutable std::map<std::string, std::optional<SelectionLevel>> levels_;  ///< from a JSON pointer to the result of `level_of`
};

}  // namespace ostraka
