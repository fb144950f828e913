// Syntax tree of a query.
#pragma once

#include "ostraka/relation/query.h"

namespace ostraka {

struct AnnotationQuery::Node {
    enum class Kind {
        either,     ///< or
        both,       ///< and
        none,       ///< not
        compare,    ///< compares two amounts; `text`: < <= > >= = !=
        count,      ///< at least `value` annotations mean words[0]
        number_of,  ///< number of annotations that mean words[0]
        related,    ///< words[0] has a relationship of type `text`, to words[1] if given
        same,       ///< attribute `text` equals that of object words[0]
        add,
        subtract,
        multiply,
        divide,
        number,    ///< `value` in `unit`
        quantity,  ///< `text` of words[0]
        word       ///< `text`: a value in a comparison; in a condition, true if such a part exists
    };
    Kind kind;
    std::size_t at = 0;  ///< column, from 1
    std::string text, unit;
    double value = 0;
    std::vector<std::string> words;
    std::vector<std::unique_ptr<Node>> of;
};

}  // namespace ostraka
