// Runs the instances of a study: unchanged instances are skipped, independent ones run in parallel.
#pragma once

#include "ostraka/core/shard.h"
#include "ostraka/workflow/record.h"

namespace ostraka {

struct RunStudyOptions {
    std::vector<std::string> only = {};  ///< steps to run, with their dependencies; empty: all
    bool dry_run = false;                ///< reports what would run without running it
    bool again = false;                  ///< ignores previous runs
    Share share = {};                    ///< shard of the instances that no other instance needs, with their dependencies
    Path program_folder = {};
};

enum class InstanceState {
    left_out,   ///< not requested
    unchanged,  ///< up to date, not run
    would_run,  ///< would run if this were not a dry run
    done,
    failed,
    skipped  ///< a dependency failed
};
std::string to_string(InstanceState state);

struct InstanceResult {
    InstanceState state = InstanceState::left_out;
    std::string why;      ///< reason for running
    std::string problem;  ///< error, if failed or skipped
    StudyRecord record;   ///< valid if done or unchanged
};

/// Throws Error (input) if a run folder, which may come from elsewhere, holds records or links that lead out of it.
void check_run_folder(const StudyPlan& plan, const Path& run_folder);

/// Runs the plan into `folder`, with at most as many instances in parallel as there are threads. Files of an instance appear,
/// with its record, when it is complete. A failed instance stops only the instances that depend on it. The watch of this thread
/// receives the running instances, the number done, and the estimated remaining time if known; instances run in parallel only
/// while its memory limit permits.
/// If an input changes during the run, the instances that use it fail. Several processes may run studies into one folder: each
/// instance is processed by one of them, the others wait and use its result. Throws Error (input), before anything runs, if the
/// folder holds names or links that lead out of it, and Error (cancelled) if the watch is cancelled; completed instances are
/// kept.
std::vector<InstanceResult> run_study(const StudyPlan& plan, const Path& folder, const RunStudyOptions& options);

}  // namespace ostraka
