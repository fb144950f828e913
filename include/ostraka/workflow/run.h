// Runs the instances of a study: what has not changed is not run again, what is independent runs side by side.
#pragma once

#include "ostraka/core/share.h"
#include "ostraka/workflow/record.h"

namespace ostraka {

struct RunStudyOptions {
    std::vector<std::string> only = {};  ///< steps, with what they need; empty: all
    bool dry_run = false;                ///< says what would run, and runs nothing
    bool again = false;                  ///< as if nothing had run before
    Share share = {};                    ///< of the instances that nothing takes, with what these need
    Path program_folder = {};
};

enum class InstanceState {
    left_out,   ///< not asked for
    unchanged,  ///< was not run again
    would_run,  ///< in a dry run
    done,
    failed,
    skipped  ///< something that it needs failed
};
std::string to_string(InstanceState state);

struct InstanceResult {
    InstanceState state = InstanceState::left_out;
    std::string why;      ///< why it ran, or would
    std::string problem;  ///< of what failed, or was skipped
    StudyRecord record;   ///< of what is done or unchanged
};

/// Throws Error (input) where a run folder, which somebody else may have made, holds records or links that lead out of it.
void check_run_folder(const StudyPlan& plan, const Path& run_folder);

/// Runs them into `folder`, at most as many at a time as there are threads: what an instance writes appears when it is complete,
/// with its record. One that fails stops those that need it, and no others. Throws Error (cancelled) when the watch of this
/// thread says so; what was done stays done. The watch is told which instances are under way, how many of how many are done, and
/// how long the rest will take, where that is known. A further instance starts beside others while the memory limit of the watch
/// is far enough. Where an input changes while the study runs, instances that take it fail. Several processes may run studies
/// into one folder: an instance is worked on by one of them, the others wait and take what it made. Throws Error (input) before
/// anything runs where the folder holds names or links that lead out of it.
std::vector<InstanceResult> run_study(const StudyPlan& plan, const Path& folder, const RunStudyOptions& options);

}  // namespace ostraka
