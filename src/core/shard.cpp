#include "ostraka/core/shard.h"

#include "ostraka/core/error.h"
#include "ostraka/core/text.h"

#include <fmt/core.h>

namespace ostraka {

Share parse_shard(const std::string& text) {
    if (text.empty()) return {};
    const std::size_t slash = text.find('/');
    const auto k = parse_int(text.substr(0, slash));
    const auto n = slash == std::string::npos ? std::nullopt : parse_int(text.substr(slash + 1));
    if (!k || !n || *k < 1 || *n < *k)
        fail_usage(fmt::format("--shard is '{}'", printable(text, 60)), "give K/N with K from 1 to N, such as 3/64");
    return {static_cast<std::size_t>(*k - 1), static_cast<std::size_t>(*n)};
}

}  // namespace ostraka
