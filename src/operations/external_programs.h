// Reports the external programs that the steps of a study start.
#pragma once

#include "operations/operations.h"

#include "ostraka/workflow/plan.h"

#include <fmt/core.h>

#include <string>

namespace ostraka {

/// Command line of the external program of a step, with each word quoted; a word known only at run time is shown as
/// "${STEP.OUTPUT}".
inline std::string program_text(const StudyPlan& plan, const StudyInstance& instance) {
    std::string text;
    auto input = instance.inputs.begin();
    for (std::string word : instance.program) {
        if (word.empty()) {
            const StudyStep& source_step = plan.study.steps[plan.instances[input->instance].step];
            word = fmt::format("${{{}.{}}}", source_step.name, input->output);
            ++input;
        }
        text += fmt::format("{}'{}'", text.empty() ? "" : " ", printable(word));
    }
    return text;
}

/// Reports the external programs that the steps of a study start, before any step runs. `allowed`: the programs may be started.
inline void show_programs(Context& context, Report& report, const StudyPlan& plan, bool allowed) {
    for (const StudyInstance& instance : plan.instances) {
        if (instance.program.empty() || is_own_program(instance.program.front())) continue;
        const std::string words = program_text(plan, instance);
        context.note(fmt::format("{} {} the program: {}", instance.title(plan.study), allowed ? "starts" : "would start", words));
        report.row("programs")("step", instance.title(plan.study))("words", words);
        if (!allowed) report.answer_no();
    }
}

}  // namespace ostraka
