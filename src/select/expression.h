// Selection expressions of recipes: one JSON object each, nested by the set operations.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/json.h"

#include <functional>
#include <string>
#include <vector>

namespace ostraka {

/// Where coordinates of a recipe lie: in the mesh's own coordinates, or between the corners of its box (0 to 1 along each axis;
/// lengths in diagonals).
struct Frame {
    bool box = false;
};

/// Evaluates expressions on one mesh. `set` holds the annotations made so far. All errors name file and JSON pointer.
class ExpressionEvaluator {
public:
    ExpressionEvaluator(const Mesh& mesh, const std::vector<std::int32_t>& face_labels, const AnnotationSet& set,
                        std::string where);

    std::vector<bool> faces(const JsonValue& expression, Frame frame, const std::string& at) const;
    std::vector<Index> vertices(const JsonValue& expression, Frame frame, const std::string& at) const;
    std::vector<std::vector<Index>> polylines(const JsonValue& expression, Frame frame, const std::string& at) const;

    /// A vertex given by index or as the one nearest to a point.
    Index vertex(const JsonValue& pick, Frame frame, const std::string& at) const;
    /// The frame an object asks for, or the one around it.
    static Frame frame_of(const JsonValue& object, Frame around);

private:
    Point point(const JsonValue& list, Frame frame) const;
    Index face(const JsonValue& pick, Frame frame, const std::string& at) const;
    std::vector<Index> picks(const JsonValue& list, Frame frame, const std::string& at) const;
    std::function<bool(const Point&)> volume(const std::string& kind, const JsonValue& value, Frame frame,
                                             const std::string& at) const;
    const Annotation& earlier(const JsonValue& id, AnnotationType type, const std::string& at) const;
    /// The kind and its value; an expression of two kinds is refused.
    std::pair<std::string, const JsonValue*> only_kind(const JsonValue& expression, const std::string& at) const;
    [[noreturn]] void fail(const std::string& at, const std::string& what, const std::string& remedy) const;

    const Mesh& mesh_;
    const std::vector<std::int32_t>& face_labels_;
    const AnnotationSet& set_;
    std::string where_;
    CGAL::Bbox_3 bounds_;
};

/// The kind of an expression (its member that is not "frame") and its value.
std::pair<std::string, const JsonValue*> kind_of(const JsonValue& expression);

}  // namespace ostraka
