#include "operations/cage/reach.h"
#include "operations/operations.h"

namespace ostraka {

void declare_reach(ReportLayout& report) {
    report.table("reach", integer("id", "id"), text("type", "constraint"), texts("parts", "parts"), integer("rows", "rows"),
                 integer("rank", "rank through the cage"), number("asked", "asked", "length"), number("left", "left", "length"),
                 number("tolerance", "tolerance", "length"), text("lacking", "most at"), text("verdict", "verdict"),
                 boolean("reached", "reached"));
}

void report_reach(Report& report, const std::vector<ConstraintReach>& reaches, const AnnotationSet& set) {
    report.empty_table("reach", false);
    for (const ConstraintReach& reach : reaches) {
        std::vector<std::string> parts;
        for (const int id : reach.annotations) parts.push_back(set.find(id)->tag);
        const Annotation* lacking = reach.lacking ? set.find(*reach.lacking) : nullptr;
        report.row("reach")("id", reach.id)("type", reach.type)("parts", parts)("rows", reach.rows)("rank", reach.rank)(
            "asked", reach.distance_after_edit)("left", reach.remaining_distance)("tolerance", reach.tolerance)(
            "lacking", lacking ? lacking->tag : "")("verdict", to_string(reach.verdict))("reached", reach.reached);
    }
}

}  // namespace ostraka
