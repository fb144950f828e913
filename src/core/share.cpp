#include "ostraka/core/share.h"

#include "ostraka/core/error.h"
#include "ostraka/core/text.h"

#include <fmt/core.h>

namespace ostraka {

Share share_from_text(const std::string& text) {
    if (text.empty()) return {};
    const std::size_t slash = text.find('/');
    const auto k = whole_of(text.substr(0, slash));
    const auto n = slash == std::string::npos ? std::nullopt : whole_of(text.substr(slash + 1));
    if (!k || !n || *k < 1 || *n < *k)
        fail_usage(fmt::format("--shard is '{}'", printable(text, 60)), "give K/N with K from 1 to N, such as 3/64");
    return {static_cast<std::size_t>(*k - 1), static_cast<std::size_t>(*n)};
}

}  // namespace ostraka
