// The constraints that a cage can satisfy, in reports.
#pragma once

#include "ostraka/framework/report.h"
#include "ostraka/semantic/cage_reach.h"

namespace ostraka {

/// Declares the table of the constraints that a cage can satisfy.
void declare_reach(ReportLayout& report);
/// Fills the table.
void report_reach(Report& report, const std::vector<ConstraintReach>& reaches, const AnnotationSet& set);

}  // namespace ostraka
