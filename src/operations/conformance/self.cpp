// conformance self
#include "operations/command_words.h"
#include "operations/conformance/cases.h"
#include "operations/operations.h"

#include "ostraka/conformance/kit.h"

namespace ostraka {

namespace {

struct ConformanceSelf final : Conformance {
    void declare(Parameters& p) override {
        p.options("record", record, "record the output of this command as the expected output, after a change of the kit")
            .unrecorded();
        declare_kit(p);
    }

    void run(Context&, Report& report) override {
        const ConformanceKit loaded_kit = read();
        const auto backend = command_backend({"/proc/self/exe"}, command_words, time_limit);
        run_cases(loaded_kit, *backend, "ostraka " + version(), record, report);
    }

    bool record = false;
};

}  // namespace

std::unique_ptr<Operation> make_conformance_self() { return make<ConformanceSelf>(); }

}  // namespace ostraka
