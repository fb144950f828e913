// The table of all operations.
#pragma once

#include "ostraka/framework/operation.h"

namespace ostraka {

/// All operations, in the order in which help and pages list them.
std::span<const OperationEntry> operations();
/// The common subject of operations whose names begin with the same words.
struct OperationGroup {
    std::string name, help;
};
std::span<const OperationGroup> operation_groups();

/// Returns the operation with this name; throws Error (usage) with the nearest name.
const OperationEntry& find_operation(const std::string& name);

}  // namespace ostraka
