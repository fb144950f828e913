// Findings of a check.
#pragma once

#include <compare>
#include <string>

namespace ostraka {

struct Finding {
    bool defect = false;  ///< false: a remark on something allowed
    std::string where;    ///< JSON pointer
    std::string text;
    auto operator<=>(const Finding&) const = default;
};

}  // namespace ostraka
