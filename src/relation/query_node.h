// What a query is made of.
#pragma once

#include "ostraka/relation/query.h"

namespace ostraka {

struct AnnotationQuery::Node {
    enum class Kind {
        either,     ///< of two: or
        both,       ///< and
        none,       ///< not
        compare,    ///< of two by `text`: < <= > >= = !=
        count,      ///< at least `value` annotations mean words[0]
        number_of,  ///< how many do
        related,    ///< by a relationship of the type `text`: words[0], and words[1] if there is one
        same,       ///< attribute `text` as the object words[0]
        add,
        subtract,
        multiply,
        divide,
        number,    ///< `value` in `unit`
        quantity,  ///< `text` of words[0]
        word       ///< `text`: a value to compare with or, where a truth is wanted, a part that there is
    };
    Kind kind;
    std::size_t at = 0;  ///< column, from 1
    std::string text, unit;
    double value = 0;
    std::vector<std::string> words;
    std::vector<std::unique_ptr<Node>> of;
};

}  // namespace ostraka
