#include "operations/conformance/cases.h"

#include "ostraka/core/progress.h"
#include "ostraka/execution/child_process.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/files/transaction.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

void Conformance::declare_kit(Parameters& p) {
    p.input_option("kit", Kind::folder, kit, "folder of the conformance kit (conformance.json); by default the installed kit");
    p.options("only", only, "names of the operations or cases to run; if left out, all are run").words();
    p.output_option("junit", Kind::report, junit, "write the results as JUnit XML");
    p.options("time-limit", time_limit, "time limit of each case", Range{0.1, 86400}, "s").unrecorded();
    p.report.values(text("kit", "kit"), integer("cases", "cases"), integer("agree", "agree"), integer("differ", "differ"),
                    integer("unsupported", "not supported"));
    p.report.table("operations", text("operation", "operation"), integer("cases", "cases"), integer("agree", "agree"),
                   integer("differ", "differ"), integer("unsupported", "not supported"));
    p.report.table("differences", text("case", "case"), text("about"), text("difference", "what differs"));
}

ConformanceKit Conformance::read() const {
    Path folder;
    if (kit) folder = kit.path();
    else
        for (const char* relative_folder :
             {"../share/ostraka/conformance", "../../data/conformance", "../../../data/conformance"})
            if (const Path candidate = executable_folder() / relative_folder;
                folder.empty() && file_exists(candidate / "conformance.json"))
                folder = candidate.lexically_normal();
    if (folder.empty())
        throw Error(ErrorKind::failure, "the conformance kit", "was not installed with this command",
                    "name its folder: --kit data/conformance of the source");
    ConformanceKit loaded_kit = read_kit(folder, find_operation);
    if (only.empty()) return loaded_kit;
    for (const std::string& name : only)
        if (std::none_of(loaded_kit.cases.begin(), loaded_kit.cases.end(),
                         [&](const ConformanceCase& entry) { return entry.id == name || entry.operation == name; }))
            fail_usage(fmt::format("--only names '{}', which is neither an operation nor a case of the kit", printable(name, 60)),
                       fmt::format("conformance.json in {} lists them", folder.string()));
    std::erase_if(loaded_kit.cases, [&](const ConformanceCase& entry) {
        return std::find(only.begin(), only.end(), entry.id) == only.end() &&
               std::find(only.begin(), only.end(), entry.operation) == only.end();
    });
    return loaded_kit;
}

void Conformance::run_cases(const ConformanceKit& loaded_kit, Backend& backend, const std::string& name, bool record,
                            Report& report) const {
    const ScratchFolder scratch("conformance");
    std::vector<CaseResult> results(loaded_kit.cases.size());
    Progress progress("cases", loaded_kit.cases.size());
    parallel_for(loaded_kit.cases.size(), 1, [&](std::size_t i) {
        // Files written by a case are not committed with the outputs of this operation.
        const TransactionScope no_transaction(nullptr);
        if (record) record_case(loaded_kit, loaded_kit.cases[i], backend, scratch.path(), find_operation);
        results[i] = run_case(loaded_kit, loaded_kit.cases[i], backend, scratch.path(), find_operation);
        progress.advance();
    });
    std::size_t counts[3]{};
    report("kit", loaded_kit.version)("cases", results.size());
    std::vector<std::string> operation_names;
    for (const ConformanceCase& entry : loaded_kit.cases)
        if (std::find(operation_names.begin(), operation_names.end(), entry.operation) == operation_names.end())
            operation_names.push_back(entry.operation);
    for (const std::string& operation : operation_names) {
        std::size_t outcome_counts[3]{};
        for (std::size_t i = 0; i < results.size(); ++i)
            if (loaded_kit.cases[i].operation == operation) ++outcome_counts[static_cast<std::size_t>(results[i].outcome)];
        report.row("operations")("operation", operation)("cases", outcome_counts[0] + outcome_counts[1] + outcome_counts[2])(
            "agree", outcome_counts[0])("differ", outcome_counts[1])("unsupported", outcome_counts[2]);
    }
    report.empty_table("differences", false);
    for (std::size_t i = 0; i < results.size(); ++i) {
        ++counts[static_cast<std::size_t>(results[i].outcome)];
        report.run("seconds." + loaded_kit.cases[i].id, results[i].seconds);
        if (results[i].outcome == Outcome::differs)
            report.row("differences")("case", loaded_kit.cases[i].id)("about", loaded_kit.cases[i].about)(
                "difference", joined(results[i].differences, "; "));
    }
    report("agree", counts[0])("differ", counts[1])("unsupported", counts[2]);
    if (counts[1] > 0) report.answer_no();
    if (junit) junit.write(junit_of(loaded_kit, results, name));
}

}  // namespace ostraka
