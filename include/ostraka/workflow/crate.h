// The run folder of a study as a Process Run Crate, and the data needed to repeat the run.
#pragma once

#include "ostraka/workflow/run.h"

namespace ostraka {

/// RO-Crate 1.1 metadata (JSON-LD) of a run in the profile Process Run Crate 0.5: one action per instance that ran, with its
/// software, settings, inputs and outputs. Files in the run folder are identified by their path; files elsewhere, and outputs
/// that were never written, by their checksum (RFC 6920). `collected`: tables and plots in the folder. The publication date is
/// the end of the last action.
Json crate_of(const StudyPlan& plan, const std::vector<InstanceResult>& results, const Path& folder,
              const std::vector<std::string>& collected);

/// The request of a run: FOLDER/run.json, with the study beside it as run.study.json.
struct RunRequest {
    Path study_folder;  ///< original folder of the study, relative to the run folder
    bool quick = false;
    std::vector<std::string> set, only;
};
Json run_request_to_json(const RunRequest& request);
/// Throws Error (input) if the folder is not a run folder.
RunRequest read_run_request(const Path& folder);

}  // namespace ostraka
