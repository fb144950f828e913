// The one table of what the toolkit can do.
#pragma once

#include "ostraka/operation/operation.h"

namespace ostraka {

/// In the order in which help and pages show them.
std::span<const OperationEntry> operations();
/// What the operations are about whose names begin with the same words.
struct OperationGroup {
    std::string name, help;
};
std::span<const OperationGroup> operation_groups();

/// Throws Error (usage) with the nearest name.
const OperationEntry& find_operation(const std::string& name);

}  // namespace ostraka
