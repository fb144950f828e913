// Golden cases, given to another program or to this one.
#pragma once

#include "operations/operations.h"

#include "ostraka/conformance/kit.h"

namespace ostraka {

/// Base of the operations that run the cases of a kit: the kit, the selection of cases, and the report.
struct Conformance : Operation {
    void declare_kit(Parameters& p);
    /// Reads the kit, and keeps the selected cases.
    [[nodiscard]] ConformanceKit read() const;
    /// Runs the cases, after recording them if `record`, and reports the results; `name`: the program, in the JUnit XML.
    void run_cases(const ConformanceKit& loaded_kit, Backend& backend, const std::string& name, bool record,
                   Report& report) const;

    FileInput kit;
    FileOutput junit{".xml"};
    std::vector<std::string> only;
    double time_limit = 120;
};

}  // namespace ostraka
