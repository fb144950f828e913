// replay: repeats a run and compares the results.
#include "operations/external_programs.h"

#include "ostraka/execution/child_process.h"
#include "ostraka/files/safe_path.h"
#include "ostraka/workflow/crate.h"

#include <map>
#include <optional>

namespace ostraka {

namespace {

/// The report without the parts that may differ between identical runs.
std::string reproducible_report(const Path& folder) {
    const Path file = folder / "report.json";
    if (!file_exists(file)) return {};
    Json report = read_json(file);
    if (report.IsObject()) report.RemoveMember("run");
    return to_compact_text(report);
}

struct Replay final : Operation {
    void declare(Parameters& p) override {
        p.input("crate", Kind::folder, crate, "folder of the earlier run, as written by 'run'");
        p.output_option("output", Kind::folder, output, "folder in which the run is repeated; a temporary folder if left out");
        p.options("inputs", inputs, "folder that replaces the folder of the study in the names of inputs").only_by_caller();
        p.options("reads", reads, "further folder from which inputs may be read; may be given more than once").only_by_caller();
        p.options("allow-programs", allow_programs, "allow steps to start external programs, which do not belong to the toolkit")
            .only_by_caller();
        p.options("programs", programs, "folder of the programs that steps name; by default the folder of this command")
            .only_by_caller();
        p.report.values(integer("steps", "steps repeated"), integer("outputs", "outputs compared"),
                        integer("same", "same to the bit"), integer("different", "different"));
        p.report.table("programs", text("step", "step"), text("words", "program"));
        p.report.table("differences", text("step", "step"), text("output", "output"), text("before"), text("now"),
                       text("what", "what differs"));
    }

    [[nodiscard]] double memory_needed(double /*input_bytes*/) const override { return 0; }

    void run(Context& context, Report& report) override {
        const Path folder = crate.path();
        for (const char* name : {"run.json", "run.study.json"}) require_writable_inside(folder / name, folder);
        const RunRequest request = read_run_request(folder);
        StudyOptions reading;
        reading.quick = request.quick;
        reading.set = request.set;
        reading.set_from_file = true;
        reading.folder = inputs.empty() ? (folder / request.study_folder).lexically_normal() : Path(inputs);
        // The folder named by the run itself is read only if the caller names it too.
        reading.reads_folder = !inputs.empty();
        reading.reads.assign(reads.begin(), reads.end());
        reading.reads.push_back(folder);
        reading.allow_programs = allow_programs;
        std::optional<StudyPlan> plan;
        context.record([&] { plan.emplace(read_study(folder / "run.study.json", find_operation, reading)); });
        show_programs(context, report, *plan, true);
        check_run_folder(*plan, folder);
        RunStudyOptions options;
        options.only = request.only;
        options.rerun_all = true;
        options.program_folder = programs.empty() ? executable_folder() : Path(programs);
        std::optional<ScratchFolder> scratch;
        if (!output) scratch.emplace("replay");
        const Path repeated = output ? output.open() : scratch->path();
        const auto results = run_study(*plan, repeated, options);
        std::size_t steps = 0, compared = 0, same = 0;
        for (std::size_t i = 0; i < results.size(); ++i) {
            const StudyInstance& instance = plan->instances[i];
            const auto before = read_record(folder / instance.folder);
            if (!before && results[i].state != InstanceState::done) continue;
            ++steps;
            const auto report_difference = [&](const std::string& name, const std::string& old_value,
                                               const std::string& new_value, const std::string& difference) {
                report.row("differences")("step", instance.title(plan->study))("output", name)("before", old_value)(
                    "now", new_value)("what", difference);
                report.answer_no();
            };
            if (!before || results[i].state != InstanceState::done) {
                report_difference("", "", "",
                                  before ? "the repeated run failed: " + results[i].problem : "the first run did not succeed");
                continue;
            }
            compare_inputs(*before, results[i].record, report_difference);
            for (const auto& [name, old_output] : before->outputs) {
                ++compared;
                const auto repeated_output = results[i].record.outputs.find(name);
                const std::string checksum =
                    repeated_output == results[i].record.outputs.end() ? "" : repeated_output->second.sha256;
                if (checksum == old_output.sha256) ++same;
                else
                    report_difference(name, old_output.sha256, checksum,
                                      checksum.empty() ? "not written by the repeated run" : "other bytes");
            }
            ++compared;
            if (reproducible_report(folder / instance.folder) == reproducible_report(repeated / instance.folder)) ++same;
            else report_difference("report", "", "", "other values");
        }
        report("steps", steps)("outputs", compared)("same", same)("different", compared - same);
    }

    template <class Differs>
    static void compare_inputs(const StudyRecord& before, const StudyRecord& now, const Differs& report_difference) {
        const std::map<std::string, std::string> current(now.depends.begin(), now.depends.end());
        for (const auto& [name, old_value] : before.depends)
            if (const auto recorded = current.find(name); recorded == current.end() || recorded->second != old_value)
                report_difference(name, old_value, recorded == current.end() ? "" : recorded->second,
                                  name == "toolkit" ? "another version" : "another input or option");
    }

    FileInput crate;
    FolderOutput output;
    bool allow_programs = false;
    std::vector<std::string> reads;
    std::string inputs, programs;
};

}  // namespace

std::unique_ptr<Operation> make_replay() { return make<Replay>(); }

}  // namespace ostraka
