// Queries on annotated objects, by parts, attributes and relationships.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/relation/graph.h"
#include "ostraka/vocabulary/tag_matcher.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace ostraka {

/// A reference to an attribute of another object, as in `same(attribute, object)`.
struct QueryReference {
    std::string attribute, object;
    auto operator<=>(const QueryReference&) const = default;
};

/// The object that a query is evaluated on.
struct QueriedObject : AnnotatedMeshView {
    const RelationGraph* graph = nullptr;    ///< nullptr: no relationship is known
    const Vocabulary* vocabulary = nullptr;  ///< used to compare words and attribute names; may be null
    /// Values of the attribute in the other object, in the form of `values_of`.
    std::function<std::vector<std::string>(const QueryReference&)> values_elsewhere;
};

struct QueryAnswer {
    bool holds = false;
    std::vector<int> annotations;       ///< ids of the annotations that satisfy the query, ascending
    std::vector<std::string> problems;  ///< comparisons that could not be made, as text: incompatible units
};

/// A query such as `2 arm and not handle`, `area(handle) >= area(body) / 3`, `related("same mould", 17)` (grammar:
/// doc/annotation-find.md). A word denotes the same annotation throughout the query, one with this meaning (TagMatcher).
/// The query holds if some assignment of annotations to words satisfies it.
class AnnotationQuery {
public:
    /// Parses a query. Throws Error (usage) with the column, the error and the remedy.
    explicit AnnotationQuery(const std::string& text);
    ~AnnotationQuery();
    AnnotationQuery(AnnotationQuery&&) noexcept;

    /// Words that stand for annotations, and names of attributes and quantities; in the order of the text, without duplicates.
    [[nodiscard]] const std::vector<std::string>& words() const;
    [[nodiscard]] const std::vector<std::string>& names() const;
    [[nodiscard]] const std::vector<QueryReference>& references() const;

    /// Evaluates the query. Quantities that are not attributes (area, perimeter, length, volume ...) are computed from the
    /// mesh. Throws Error (input) for more than a million assignments. Thread-safe.
    [[nodiscard]] QueryAnswer ask(const QueriedObject& object) const;

    struct Node;

private:
    std::unique_ptr<const Node> root_;
    std::vector<std::string> words_, variables_, names_;
    std::vector<QueryReference> references_;
};

/// All values that annotations of the set have for the attribute of that name (in any language of the vocabulary), as text that
/// is equal for equal values; ascending, without duplicates.
std::vector<std::string> values_of(const QueriedObject& object, const std::string& attribute);

}  // namespace ostraka
