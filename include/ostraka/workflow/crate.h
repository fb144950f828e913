// The run folder of a study as a Process Run Crate, and what it takes to repeat the run.
#pragma once

#include "ostraka/workflow/run.h"

namespace ostraka {

/// RO-Crate 1.1 metadata (JSON-LD) of a run, by the profile Process Run Crate 0.5: an action for each instance that ran, with the
/// software, its settings, and inputs and outputs. Files in the run folder are named by their place; what lies elsewhere or was
/// never written by its checksum (RFC 6920). `collected`: tables and plots in the folder. The last action's end is the date of
/// publication.
Json crate_of(const StudyPlan& plan, const std::vector<InstanceResult>& results, const Path& folder,
              const std::vector<std::string>& collected);

/// What a run was asked for: FOLDER/run.json, with the study beside it as run.study.json.
struct RunRequest {
    Path study_folder;  ///< where the study stood, as seen from the run folder
    bool quick = false;
    std::vector<std::string> set, only;
};
Json run_request_to_json(const RunRequest& request);
/// Throws Error (input) where the folder is none of a run.
RunRequest read_run_request(const Path& folder);

}  // namespace ostraka
