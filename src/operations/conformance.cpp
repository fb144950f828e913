// conformance run, conformance self: golden cases, given to another program or to this one.
#include "operations.h"

#include "ostraka/conformance/kit.h"
#include "ostraka/core/child_process.h"
#include "ostraka/core/parallel.h"
#include "ostraka/core/progress.h"
#include "ostraka/core/transaction.h"
#include "ostraka/operations/command_words.h"

#include <algorithm>

namespace ostraka {

namespace {

/// Shared by both operations: the kit, the selection of cases, and the report.
struct Conformance : Operation {
    void describe_kit(Parameters& p) {
        p.input_option("kit", Kind::folder, kit, "folder of the kit (conformance.json); else the one that came with the command");
        p.options("only", only, "operations or cases, instead of all").words();
        p.output_option("junit", Kind::report, junit, "write the results as JUnit XML");
        p.options("time-limit", time_limit, "time limit of a case", Range{0.1, 86400}, "s").unrecorded();
        p.report.values(text("kit", "kit"), integer("cases", "cases"), integer("agree", "agree"), integer("differ", "differ"),
                        integer("unsupported", "not supported"));
        p.report.table("operations", text("operation", "operation"), integer("cases", "cases"), integer("agree", "agree"),
                       integer("differ", "differ"), integer("unsupported", "not supported"));
        p.report.table("differences", text("case", "case"), text("about"), text("difference", "what differs"));
    }

    [[nodiscard]] ConformanceKit read() const {
        Path folder;
        if (kit) folder = kit.path();
        else
            for (const char* place : {"../share/ostraka/conformance", "../../data/conformance", "../../../data/conformance"})
                if (const Path there = own_program_folder() / place; folder.empty() && file_exists(there / "conformance.json"))
                    folder = there.lexically_normal();
        if (folder.empty())
            throw Error(ErrorKind::failure, "the conformance kit", "did not come with this command",
                        "name its folder: --kit data/conformance of the source");
        ConformanceKit known = read_kit(folder, find_operation);
        if (only.empty()) return known;
        for (const std::string& name : only)
            if (std::none_of(known.cases.begin(), known.cases.end(),
                             [&](const ConformanceCase& one) { return one.id == name || one.operation == name; }))
                fail_usage("--only names '" + printable(name, 60) + "', which is neither an operation nor a case of the kit",
                           "conformance.json in " + folder.string() + " lists them");
        std::erase_if(known.cases, [&](const ConformanceCase& one) {
            return std::find(only.begin(), only.end(), one.id) == only.end() &&
                   std::find(only.begin(), only.end(), one.operation) == only.end();
        });
        return known;
    }

    void judge(const ConformanceKit& known, Backend& backend, const std::string& name, bool record, Report& report) const {
        const ScratchFolder scratch("conformance");
        std::vector<CaseResult> results(known.cases.size());
        Progress progress("cases", known.cases.size());
        parallel_for(
            known.cases.size(),
            [&](std::size_t i) {
                // Files written by a case are not committed with the outputs of this operation.
                const TransactionScope none(nullptr);
                if (record) record_case(known, known.cases[i], backend, scratch.path(), find_operation);
                results[i] = run_case(known, known.cases[i], backend, scratch.path(), find_operation);
                progress.advance();
            },
            1);
        std::size_t counts[3]{};
        report("kit", known.version)("cases", results.size());
        std::vector<std::string> operations_there;
        for (const ConformanceCase& one : known.cases)
            if (std::find(operations_there.begin(), operations_there.end(), one.operation) == operations_there.end())
                operations_there.push_back(one.operation);
        for (const std::string& operation : operations_there) {
            std::size_t of[3]{};
            for (std::size_t i = 0; i < results.size(); ++i)
                if (known.cases[i].operation == operation) ++of[static_cast<std::size_t>(results[i].outcome)];
            report.row("operations")("operation", operation)("cases", of[0] + of[1] + of[2])("agree", of[0])("differ", of[1])(
                "unsupported", of[2]);
        }
        report.empty_table("differences", false);
        for (std::size_t i = 0; i < results.size(); ++i) {
            ++counts[static_cast<std::size_t>(results[i].outcome)];
            report.run("seconds." + known.cases[i].id, results[i].seconds);
            if (results[i].outcome == Outcome::differs)
                report.row("differences")("case", known.cases[i].id)("about", known.cases[i].about)(
                    "difference", joined(results[i].differences, "; "));
        }
        report("agree", counts[0])("differ", counts[1])("unsupported", counts[2]);
        if (counts[1] > 0) report.answer_no();
        if (junit) junit.write(junit_of(known, results, name));
    }

    FileInput kit;
    FileOutput junit{".xml"};
    std::vector<std::string> only;
    double time_limit = 120;
};

struct ConformanceRun final : Conformance {
    void describe(Parameters& p) override {
        p.options("command", command, "the program and its first words, behind --").positional().words();
        p.options("lines", lines, "start the program once, and give it a line of JSON for each case (doc/conformance.md)");
        describe_kit(p);
    }

    void check() const override {
        if (command.empty())
            fail_usage("no command is given", "write it behind --: ostraka conformance run -- python3 backend.py");
    }

    void run(Context&, Report& report) override {
        const ConformanceKit known = read();
        const auto backend = lines ? lines_backend(command, time_limit) : command_backend(command, command_words, time_limit);
        judge(known, *backend, joined(command, " "), false, report);
    }

    std::vector<std::string> command;
    bool lines = false;
};

struct ConformanceSelf final : Conformance {
    void describe(Parameters& p) override {
        p.options("record", record, "record the output of this command as the expected output: for those who change the kit")
            .unrecorded();
        describe_kit(p);
    }

    void run(Context&, Report& report) override {
        const ConformanceKit known = read();
        const auto backend = command_backend({"/proc/self/exe"}, command_words, time_limit);
        judge(known, *backend, "ostraka " + version(), record, report);
    }

    bool record = false;
};

}  // namespace

std::unique_ptr<Operation> make_conformance_run() { return make<ConformanceRun>(); }
std::unique_ptr<Operation> make_conformance_self() { return make<ConformanceSelf>(); }

}  // namespace ostraka
