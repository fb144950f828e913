// conformance run
#include "operations/command_words.h"
#include "operations/conformance/cases.h"
#include "operations/operations.h"

#include "ostraka/conformance/kit.h"

namespace ostraka {

namespace {

struct ConformanceRun final : Conformance {
    void declare(Parameters& p) override {
        p.options("command", command, "program to test and its first arguments, after --").positional().words();
        p.options("lines", lines, "start the program once, and send it each case as a line of JSON (doc/conformance.md)");
        declare_kit(p);
    }

    void check() const override {
        if (command.empty())
            fail_usage("no command is given", "write it after --: ostraka conformance run -- python3 backend.py");
    }

    void run(Context&, Report& report) override {
        const ConformanceKit loaded_kit = read();
        const auto backend =
            lines ? json_lines_backend(command, time_limit) : command_backend(command, command_words, time_limit);
        run_cases(loaded_kit, *backend, joined(command, " "), false, report);
    }

    std::vector<std::string> command;
    bool lines = false;
};

}  // namespace

std::unique_ptr<Operation> make_conformance_run() { return make<ConformanceRun>(); }

}  // namespace ostraka
