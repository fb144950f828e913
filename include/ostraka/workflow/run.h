// Runs the instances of a study: unchanged instances are skipped, independent instances run in parallel.
#pragma once

#include "ostraka/core/shard.h"
#include "ostraka/workflow/record.h"

namespace ostraka {

struct RunStudyOptions {
    /// Names of the steps to run; the steps on which they depend are run too. Empty: all steps.
    std::vector<std::string> only = {};
    bool dry_run = false;    ///< true: report what would run, without running it
    bool rerun_all = false;  ///< true: run all instances, ignoring the results of previous runs
    /// Shard to run: a share of the final instances (those that no other instance needs), with their dependencies.
    Share share = {};
    Path program_folder = {};  ///< folder of the programs
};

/// Outcome of an instance.
enum class InstanceState {
    left_out,   ///< the step was not requested
    unchanged,  ///< up to date, therefore not run
    would_run,  ///< would run if this were not a dry run
    done,
    failed,
    skipped  ///< done: it ran; failed: it failed; skipped: it was not run, because an instance that it needs failed
};
std::string to_string(InstanceState state);

struct InstanceResult {
    InstanceState state = InstanceState::left_out;  ///< state after the run
    std::string why;                                ///< reason why the instance was run or would be run
    std::string problem;                            ///< error message, if failed or skipped
    StudyRecord record;                             ///< record of the instance, if done or unchanged
};

/// Throws Error (input) if a run folder of unknown origin contains records or links that lead out of the folder.
void check_run_folder(const StudyPlan& plan, const Path& run_folder);

/// Runs the instances of a plan in `folder`, with at most as many instances in parallel as there are threads. The files and the
/// record of an instance get their final names when the instance is complete. A failed instance stops only the instances that
/// depend on it. The progress watch of the current thread receives the running instances, the number of finished instances, and
/// the estimated remaining time if known; instances run in parallel only while the watch's memory limit permits. If an input
/// changes during the run, the instances that use it fail. Several processes may run studies in one folder: each instance is run
/// by one process, and the other processes wait and use its result. Throws Error (input), before anything runs, if the folder
/// holds names or links that lead out of it, and Error (cancelled) if the watch is cancelled; completed instances are kept.
std::vector<InstanceResult> run_study(const StudyPlan& plan, const Path& folder, const RunStudyOptions& options);

}  // namespace ostraka
