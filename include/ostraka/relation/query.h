// Queries on annotated objects, by parts, attributes and relationships.
#pragma once

#include "ostraka/relation/graph.h"
#include "ostraka/vocabulary/tag_words.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace ostraka {

/// An attribute of another object, which `same(attribute, object)` compares with.
struct QueryReference {
    std::string attribute, object;
    auto operator<=>(const QueryReference&) const = default;
};

/// What a query is asked of.
struct QueriedObject {
    const Mesh* mesh = nullptr;
    const AnnotationSet* set = nullptr;
    const RelationGraph* graph = nullptr;    ///< nullptr: no relationship is known
    const Vocabulary* vocabulary = nullptr;  ///< by which words and names of attributes are compared; may be none
    /// The values that the named object has of the attribute, as `values_of` gives them.
    std::function<std::vector<std::string>(const QueryReference&)> values_elsewhere;
};

struct QueryAnswer {
    bool holds = false;
    std::vector<int> annotations;       ///< ids of those by which it holds, ascending
    std::vector<std::string> problems;  ///< comparisons that could not be made, in words: units that do not go together
};

/// A query such as `2 arm and not handle`, `area(handle) >= area(body) / 3`, `related("same mould", 17)` (grammar:
/// doc/annotation-find.md). A word stands for one annotation that means it (TagWords) throughout the query: it holds if it does
/// for some choice of one annotation for each word.
class AnnotationQuery {
public:
    /// Throws Error (usage) with the column, what is wrong and the remedy.
    explicit AnnotationQuery(const std::string& text);
    ~AnnotationQuery();
    AnnotationQuery(AnnotationQuery&&) noexcept;

    /// Words that stand for annotations, and names of attributes and quantities, in the order of the text, none twice.
    [[nodiscard]] const std::vector<std::string>& words() const;
    [[nodiscard]] const std::vector<std::string>& names() const;
    [[nodiscard]] const std::vector<QueryReference>& references() const;

    /// Quantities that are no attribute (area, perimeter, length, volume ...) are computed from the mesh. Throws Error (input)
    /// for more than a million choices. Safe for several threads at once.
    [[nodiscard]] QueryAnswer ask(const QueriedObject& object) const;

    struct Node;

private:
    std::unique_ptr<const Node> root_;
    std::vector<std::string> words_, variables_, names_;
    std::vector<QueryReference> references_;
};

/// All values of the attribute of that name (in any language of the vocabulary) that annotations of the set have, as text that is
/// the same for the same value; ascending, none twice.
std::vector<std::string> values_of(const QueriedObject& object, const std::string& attribute);

}  // namespace ostraka
