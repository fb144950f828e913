#include "operations/annotation/differences.h"
#include "operations/operations.h"

#include <fmt/core.h>

namespace ostraka {

void declare_differences(ReportLayout& layout, const std::string& table) {
    layout.table(table, integer("id", "id"), text("tag", "tag"), text("kind", "what"), text("field", "field"),
                 text("before", "before"), text("after", "after"), integer("onlyBefore"), integer("onlyAfter"));
}

void add_differences(Report& report, const std::string& table, const std::vector<Difference>& changes, const std::string& none) {
    report.empty_table(table, false);
    if (changes.empty()) report.line(none);
    for (const Difference& change : changes) {
        Report::Row row = named_row(report, table, change);
        row("kind", change.kind == Difference::Kind::added     ? "added"
                    : change.kind == Difference::Kind::removed ? "removed"
                                                               : "changed");
        std::string counts;
        if (change.field == "geometry") {
            row("onlyBefore", change.only_before)("onlyAfter", change.only_after);
            counts = fmt::format(" (-{} +{})", change.only_before, change.only_after);
        }
        row("before", change.before)("after", change.after, change.after + counts);
    }
}

}  // namespace ostraka
