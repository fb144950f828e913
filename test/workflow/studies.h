// Shared by the tests of studies.
#pragma once

#include "ostraka/execution/parallel.h"
#include "ostraka/operations/table.h"
#include "ostraka/workflow/collect.h"
#include "scratch.h"

namespace ostraka::test {

/// A study file with these members.
inline std::string study_text_of(const std::string& members) {
    return R"({"format": "ostraka-study", "version": 1, )" + members + "}";
}

inline StudyPlan plan_of(const Path& file, const StudyOptions& options = {}) {
    StudyPlan plan(read_study(file, find_operation, options));
    check_collected(plan);
    return plan;
}

inline std::vector<InstanceResult> run_all(const StudyPlan& plan, const Path& folder, RunStudyOptions options = {}) {
    return run_study(plan, folder, options);
}

inline std::size_t count(const std::vector<InstanceResult>& results, InstanceState state) {
    std::size_t n = 0;
    for (const auto& result : results) n += result.state == state ? 1 : 0;
    return n;
}

/// A teapot at two resolutions, annotated and transferred.
inline const char* const teapot_study = R"("title": "A teapot",
  "parameters": {"vertices": [2500, 4000], "spikes": "prune"},
  "quick": {"vertices": [2500]},
  "steps": {
    "pot": {"operation": "mesh make", "with": {"object": "teapot", "vertices": 3000}},
    "annotated": {"operation": "annotation apply", "with": {"mesh": "${pot.output}", "recipe": "teapot.recipe.json"}, "keep": ["output"]},
    "fine": {"operation": "mesh make", "with": {"object": "teapot", "vertices": "${vertices}"}},
    "transfer": {"operation": "annotation transfer", "keep": {"output": "pot-${vertices}.ant.json"},
      "with": {"source": "${pot.output}", "annotations": "${annotated.output}", "target": "${fine.output}", "spikes": "${spikes}"}},
    "look": {"operation": "annotation list", "with": {"mesh": "${fine.output}", "annotations": "${transfer.output}"}}
  })";

inline void furnish_teapot(const Scratch& scratch) {
    write_file(scratch / "teapot.recipe.json", read_file(Path(OSTRAKA_SOURCE_DIR) / "data" / "teapot.recipe.json"));
}

}  // namespace ostraka::test
