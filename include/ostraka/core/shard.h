// Sharding: the work is divided into N shards, which different machines process.
#pragma once

#include <cstddef>
#include <string>

namespace ostraka {

/// One shard of the work.
struct Share {
    /// Index of the shard (0 <= index < count) and number of shards; 0 of 1 is the whole work.
    std::size_t index = 0, count = 1;

    [[nodiscard]] bool is_whole() const { return count == 1; }  ///< true if the work is not divided
    /// True if item i belongs to this shard: i = index modulo count.
    [[nodiscard]] bool has(std::size_t i) const { return i % count == index; }
    bool operator==(const Share&) const = default;
};

/// Parses the option --shard, "K/N" with K from 1 to N; an empty text is the whole work. Throws Error (usage) for anything else,
/// naming the option --shard.
Share parse_shard(const std::string& text);

}  // namespace ostraka
