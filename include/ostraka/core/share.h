// The K-th of N parts of some work, for machines that do a part each.
#pragma once

#include <cstddef>
#include <string>

namespace ostraka {

struct Share {
    std::size_t index = 0, count = 1;  ///< index is below count; one of one is the whole

    [[nodiscard]] bool is_whole() const { return count == 1; }
    /// Every count-th, beginning with the index: each belongs to one share.
    [[nodiscard]] bool has(std::size_t i) const { return i % count == index; }
    bool operator==(const Share&) const = default;
};

/// "K/N" with K from 1 to N; the whole for an empty text. Throws Error (usage) for anything else, naming the option --shard.
Share share_from_text(const std::string& text);

}  // namespace ostraka
