// run: executes the steps of a study file.
#include "operations/external_programs.h"

#include "ostraka/execution/child_process.h"
#include "ostraka/files/safe_path.h"
#include "ostraka/workflow/collect.h"
#include "ostraka/workflow/crate.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

namespace ostraka {

namespace {

/// Reports the number of instances per state, for each step.
void report_steps(Report& report, const StudyPlan& plan, const std::vector<InstanceResult>& results) {
    std::map<InstanceState, std::size_t> total_count;
    for (std::size_t s = 0; s < plan.study.steps.size(); ++s) {
        std::map<InstanceState, std::size_t> step_count;
        double seconds = 0;
        for (const std::size_t i : plan.instances_of(s)) {
            ++step_count[results[i].state];
            ++total_count[results[i].state];
            if (results[i].state == InstanceState::done) seconds += results[i].record.seconds;
        }
        const StudyStep& step = plan.study.steps[s];
        Report::Row row = report.row("steps");
        row("step", step.name)("operation", step.operation == nullptr ? "(a program)" : step.operation->name)(
            "instances", plan.instances_of(s).size());
        row("done", step_count[InstanceState::done] + step_count[InstanceState::would_run])("unchanged",
                                                                                            step_count[InstanceState::unchanged]);
        row("failed", step_count[InstanceState::failed])("skipped", step_count[InstanceState::skipped]);
        if (seconds > 0) report.run("seconds." + step.name, seconds);
    }
    report("instances", plan.instances.size())("done", total_count[InstanceState::done])("wouldRun",
                                                                                         total_count[InstanceState::would_run]);
    report("unchanged", total_count[InstanceState::unchanged])("failed", total_count[InstanceState::failed])(
        "skipped", total_count[InstanceState::skipped]);
}

struct Run final : Operation {
    void declare(Parameters& p) override {
        p.input("study", Kind::study, study, "study file (.study.json), with steps, parameters, tables and plots");
        p.output_option("output", Kind::folder, output,
                        "folder of the run, for results, tables, page and provenance; NAME-run if left out");
        p.options("quick", quick,
                  "use the parameters under 'quick' in the study, and omit the steps that the study marks as slow")
            .unrecorded();
        p.options("set", set, "NAME=VALUE or NAME=VALUE,VALUE: values of a parameter, which replace the values in the study")
            .unrecorded();
        p.options("only", only, "names of steps to run; the steps whose outputs they need also run").words().unrecorded();
        p.options("dry-run", dry_run, "check the study, and report which steps would run and why, without running them")
            .unrecorded();
        p.options("explain", explain, "name of a step: report why this step would run again").unrecorded();
        p.options("again", again, "run all steps, including unchanged steps").unrecorded();
        p.options("shard", shard,
                  "K/N: process only the K-th of N shards of the steps; if left out, all remaining steps are run and the results "
                  "of all shards are gathered")
            .unrecorded();
        p.options("reads", reads, "folder from which inputs may be read, besides the folder of the study; repeatable")
            .only_by_caller();
        p.options("allow-programs", allow_programs, "allow steps to start external programs, which do not belong to the toolkit")
            .only_by_caller();
        p.options("programs", programs, "folder of the programs that steps name; by default the folder of this command")
            .only_by_caller();
        p.report.values(text("output"), integer("instances", "steps to run"), integer("done", "done"),
                        integer("wouldRun", "would run"), integer("unchanged", "unchanged"), integer("failed", "failed"),
                        integer("skipped", "skipped"));
        p.report.table("steps", text("step", "step"), text("operation", "operation"), integer("instances", "runs"),
                       integer("done", "done"), integer("unchanged", "unchanged"), integer("failed", "failed"),
                       integer("skipped", "skipped"));
        p.report.table("reasons", text("step", "step"), text("state", "state"), text("why", "why"));
        p.report.table("programs", text("step", "step"), text("words", "program"));
        p.report.table("failures", text("step", "step"), text("problem", "problem"));
    }

    void check() const override {
        if (dry_run && again) fail_usage("--dry-run and --again contradict each other", "give one of them");
        static_cast<void>(parse_shard(shard));
    }

    [[nodiscard]] double memory_needed(double /*input_bytes*/) const override { return 0; }  // memory is checked for each step

    void run(Context& context, Report& report) override {
        RunStudyOptions options;
        options.only = only;
        options.dry_run = dry_run || !explain.empty();
        options.rerun_all = again;
        options.share = parse_shard(shard);
        options.program_folder = programs.empty() ? executable_folder() : Path(programs);
        if (!explain.empty()) options.only = {explain};
        const Path file = study.path();
        StudyOptions reading;
        reading.quick = quick;
        reading.set = set;
        reading.reads.assign(reads.begin(), reads.end());
        reading.allow_programs = allow_programs || dry_run;  // a dry run lists them
        std::optional<StudyPlan> plan;
        context.record([&] { plan.emplace(read_study(file, find_operation, reading)); });
        check_collected(*plan);
        show_programs(context, report, *plan, allow_programs);
        if (!dry_run || allow_programs) check_programs(*plan, options);
        if (!dry_run && explain.empty()) {
            if (!output) output.sources.push_back({run_folder(file), {}});
            output.open();
        }
        const Path folder = output ? output.path() : run_folder(file);
        for (const StudyInstance& instance : plan->instances)
            for (const StudyInput& input : instance.inputs)
                if (!input.file.empty() && is_inside(input.file, folder) && !is_inside(folder, input.file))
                    throw Error(
                        ErrorKind::input, plan->study.file.string(),
                        fmt::format("'{}' is an input, and lies in the run folder {}", input.file.string(), folder.string()),
                        "name another run folder (--output)");
        const auto results = run_study(*plan, folder, options);
        report("output", folder.string());
        report_steps(report, *plan, results);
        for (std::size_t i = 0; i < results.size(); ++i) {
            const std::string title = plan->instances[i].title(plan->study);
            if (results[i].state == InstanceState::failed || results[i].state == InstanceState::skipped)
                report.row("failures")("step", title)("problem", results[i].problem);
            const bool is_explained = !explain.empty() && plan->study.steps[plan->instances[i].step].name == explain;
            if (options.dry_run && (is_explained || (explain.empty() && results[i].state == InstanceState::would_run)))
                report.row("reasons")("step", title)("state", to_string(results[i].state))(
                    "why", results[i].state == InstanceState::unchanged ? "nothing has changed" : results[i].why);
            if (results[i].state == InstanceState::failed) report.answer_no();
        }
        if (options.dry_run) return;
        if (!options.share.is_whole()) {
            report.line(fmt::format("shard {} is done; run it without --shard to gather the shards", shard));
            return;
        }
        auto written = write_study_tables(*plan, results, folder, [&](const std::string& name) { return output.in(name); });
        const auto absolute_path = [](const Path& path) {
            return std::filesystem::weakly_canonical(std::filesystem::absolute(path));
        };
        const RunRequest request{absolute_path(plan->study.folder).lexically_relative(absolute_path(folder)), quick, set, only};
        write_json(output.in("run.json"), run_request_to_json(request));
        write_file(output.in("run.study.json"), read_file(file));
        const Json crate = crate_of(*plan, results, folder, written);
        write_json(output.in("ro-crate-metadata.json"), crate);
        report.line("page: " + (folder / "page.md").string());
    }

private:
    /// Checks the programs of the requested steps and of the steps they depend on.
    void check_programs(const StudyPlan& plan, const RunStudyOptions& options) const {
        std::set<std::size_t> required;
        std::vector<std::size_t> pending;
        for (std::size_t i = 0; i < plan.instances.size(); ++i) {
            const std::string& name = plan.study.steps[plan.instances[i].step].name;
            if (options.only.empty() || std::find(options.only.begin(), options.only.end(), name) != options.only.end())
                pending.push_back(i);
        }
        while (!pending.empty()) {
            const std::size_t i = pending.back();
            pending.pop_back();
            if (required.insert(i).second)
                pending.insert(pending.end(), plan.instances[i].needs.begin(), plan.instances[i].needs.end());
        }
        for (const std::size_t i : required) {
            const StudyStep& step = plan.study.steps[plan.instances[i].step];
            if (step.operation == nullptr)
                static_cast<void>(find_program(text_of(*step.program.front().value), options.program_folder,
                                               plan.study.at(step.place + "/program/0")));
        }
    }

    static Path run_folder(const Path& file) {
        std::string name = file.filename().string();
        for (const char* ending : {".json", ".study"})
            if (name.ends_with(ending)) name = name.substr(0, name.size() - std::string_view(ending).size());
        return name + "-run";
    }

    FileInput study;
    FolderOutput output;
    bool quick = false, dry_run = false, again = false, allow_programs = false;
    std::vector<std::string> set, only, reads;
    std::string explain, shard, programs;
};

}  // namespace

std::unique_ptr<Operation> make_run() { return make<Run>(); }

}  // namespace ostraka
