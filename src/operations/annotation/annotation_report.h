// Annotations in reports.
#pragma once

#include "operations/operations.h"

namespace ostraka {

/// Declares the values and the table of annotations.
void declare_annotations(ReportLayout& layout);

/// Reports the annotations of the set.
void report_annotations(Context& context, Report& report, AnnotatedMeshView object);

}  // namespace ostraka
