// What the files of operations share.
#pragma once

#include "ostraka/operations/table.h"

#include "arguments.h"

#include "ostraka/core/json_build.h"
#include "ostraka/core/stopwatch.h"
#include "ostraka/core/words.h"

namespace ostraka {

using namespace fields;

/// How the table (table.cpp) makes an operation; defined in the file of its name.
template <class Work>
std::unique_ptr<Operation> make() {
    return std::make_unique<Work>();
}

}  // namespace ostraka
