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

/// A reference to an attribute of another object, as in the query `same(attribute, object)`.
struct QueryReference {
    std::string attribute, object;  ///< name of the attribute; name of the object
    auto operator<=>(const QueryReference&) const = default;
};

/// The annotated object on which a query is evaluated.
struct QueriedObject : AnnotatedMeshView {
    const RelationGraph* graph = nullptr;  ///< relationships of the annotations; nullptr: none are known
    /// Vocabulary for comparing words and attribute names by meaning; null: they are compared by spelling.
    const Vocabulary* vocabulary = nullptr;
    /// Returns the values that an attribute has in another object, in the form that `values_of` returns.
    std::function<std::vector<std::string>(const QueryReference&)> values_elsewhere;
};

/// Result of a query on one object.
struct QueryAnswer {
    bool holds = false;                 ///< true: the object satisfies the query
    std::vector<int> annotations;       ///< ids of the annotations that satisfy the query, ascending
    std::vector<std::string> problems;  ///< messages about comparisons that are impossible because of incompatible units
};

/// A query such as `2 arm and not handle`, `area(handle) >= area(body) / 3`, `related("same mould", 17)` (grammar:
/// doc/annotation-find.md). A word stands for an annotation whose tag has this meaning (TagMatcher); all occurrences of a word
/// stand for the same annotation. The query holds if there is an assignment of annotations to words that satisfies it.
class AnnotationQuery {
public:
    /// Parses a query. Throws Error (usage) with the column, the error and the remedy.
    explicit AnnotationQuery(const std::string& text);
    ~AnnotationQuery();
    AnnotationQuery(AnnotationQuery&&) noexcept;

    /// Words of the query that stand for annotations, in the order of the text, without duplicates.
    [[nodiscard]] const std::vector<std::string>& words() const;
    /// Names of attributes and quantities in the query, in the order of the text, without duplicates.
    [[nodiscard]] const std::vector<std::string>& names() const;
    /// References to attributes of other objects.
    [[nodiscard]] const std::vector<QueryReference>& references() const;

    /// Evaluates the query on an object. Quantities that are not attributes (area, perimeter, length, volume ...) are computed
    /// from the mesh. Throws Error (input) for more than a million assignments. Calls are thread-safe.
    [[nodiscard]] QueryAnswer ask(const QueriedObject& object) const;

    struct Node;

private:
    std::unique_ptr<const Node> root_;
    std::vector<std::string> words_, variables_, names_;
    std::vector<QueryReference> references_;
};

/// All values of the attribute of this name (in any language of the vocabulary) in the annotations of the object, as texts;
/// equal values have equal texts. Ascending, without duplicates.
std::vector<std::string> values_of(const QueriedObject& object, const std::string& attribute);

}  // namespace ostraka
