// Describes the run folder of a study as a Process Run Crate, and stores the data needed to repeat the run.
#pragma once

#include "ostraka/workflow/run.h"

namespace ostraka {

/// RO-Crate 1.1 metadata (JSON-LD) of a run in the profile Process Run Crate 0.5: one action per instance that ran, with its
/// software, settings, inputs and outputs. Files in the run folder are identified by their path; files elsewhere, and outputs
/// that were never written, by their checksum (RFC 6920). `collected`: file names of tables and plots in the folder. The
/// publication date is the end of the last action.
Json crate_of(const StudyPlan& plan, const std::vector<InstanceResult>& results, const Path& folder,
              const std::vector<std::string>& collected);

/// The request with which a study was run, stored as FOLDER/run.json; the study file is stored beside it as run.study.json.
struct RunRequest {
    Path study_folder;                   ///< original folder of the study file, relative to the run folder
    bool quick = false;                  ///< true: a quick run
    std::vector<std::string> set, only;  ///< options "set" and "only" of the run
};
Json run_request_to_json(const RunRequest& request);  ///< the request as JSON
/// Reads the request of a run. Throws Error (input) if the folder is not a run folder.
RunRequest read_run_request(const Path& folder);

}  // namespace ostraka
