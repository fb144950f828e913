// template check
#include "operations/template/inspection.h"

namespace ostraka {

namespace {

struct TemplateCheck final : TemplateInspection {
    TemplateCheck() : TemplateInspection(false) {}
};

}  // namespace

std::unique_ptr<Operation> make_template_check() { return make<TemplateCheck>(); }

}  // namespace ostraka
