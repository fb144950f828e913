// What a check found.
#pragma once

#include <compare>
#include <string>

namespace ostraka {

struct Finding {
    bool defect = false;  ///< false: a remark on something that is allowed but worth knowing
    std::string where;    ///< JSON pointer
    std::string text;
    auto operator<=>(const Finding&) const = default;
};

}  // namespace ostraka
