// The table of all operations.
#pragma once

#include "ostraka/framework/operation.h"

namespace ostraka {

/// All operations, in the order in which help texts and documentation pages list them.
std::span<const OperationEntry> operations();
/// Operations whose names begin with the same words.
struct OperationGroup {
    std::string name, help;  ///< common first words of the names; subject of the operations
};
/// All groups of operations, for help texts.
std::span<const OperationGroup> operation_groups();

/// Returns the operation with this name; throws Error (usage), which suggests the most similar name, if there is none.
const OperationEntry& find_operation(const std::string& name);

}  // namespace ostraka
