// Syntax tree of a query.
#pragma once

#include "ostraka/relation/query.h"

namespace ostraka {

/// A node of the syntax tree of a query.
struct AnnotationQuery::Node {
    enum class Kind {
        either,     ///< at least one of the conditions in `of` holds
        both,       ///< all conditions in `of` hold
        none,       ///< the condition `of[0]` does not hold
        compare,    ///< compares the amounts `of[0]` and `of[1]`; `text`: < <= > >= = !=
        count,      ///< at least `value` annotations have the meaning words[0]
        number_of,  ///< number of annotations with the meaning words[0]
        related,    ///< words[0] has a relationship of type `text`, with words[1] if given
        same,       ///< attribute `text` has the same value as in the object words[0]
        add,
        subtract,
        multiply,
        divide,
        number,    ///< the number `value` in `unit`
        quantity,  ///< quantity or attribute `text` of the annotation words[0]
        word       ///< `text`: a value in a comparison; in a condition, true if an annotation with this meaning exists
    };
    Kind kind;
    std::size_t at = 0;                     ///< column of the query's text at which the node begins, from 1
    std::string text, unit;                 ///< see Kind
    double value = 0;                       ///< see Kind
    std::vector<std::string> words;         ///< words that stand for annotations, see Kind
    std::vector<std::unique_ptr<Node>> of;  ///< operands
};

}  // namespace ostraka
