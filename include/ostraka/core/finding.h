// Findings of a check: defects and remarks.
#pragma once

#include <compare>
#include <string>

namespace ostraka {

/// A defect or a remark found by a check.
struct Finding {
    bool defect = false;  ///< true: a defect; false: a remark about something allowed
    std::string where;    ///< location of the finding (a JSON pointer, for files)
    std::string text;     ///< the finding in words
    auto operator<=>(const Finding&) const = default;
};

}  // namespace ostraka
