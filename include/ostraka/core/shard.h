// Sharding: one of N parts of some work, for machines that do one part each.
#pragma once

#include <cstddef>
#include <string>

namespace ostraka {

struct Share {
    std::size_t index = 0, count = 1;  ///< 0 <= index < count; 0 of 1 is the whole work

    [[nodiscard]] bool is_whole() const { return count == 1; }
    /// Whether item i belongs to this shard: i = index modulo count.
    [[nodiscard]] bool has(std::size_t i) const { return i % count == index; }
    bool operator==(const Share&) const = default;
};

/// Parses "K/N" with K from 1 to N; an empty text is the whole work. Throws Error (usage) for anything else, naming the option
/// --shard.
Share parse_shard(const std::string& text);

}  // namespace ostraka
