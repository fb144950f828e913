// The format of a file of annotations that other programs use.
#pragma once

#include "operations/operations.h"

#include "ostraka/interchange/interchange.h"

namespace ostraka {

/// Declares --format.
inline void declare_format(Parameters& p, std::optional<std::string>& format) {
    p.options("format", format, "format of the file; needed if the file's extension does not determine the format",
              Choices(interchange_formats()));
}

}  // namespace ostraka
