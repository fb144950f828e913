// template show
#include "operations/template/inspection.h"

namespace ostraka {

namespace {

struct TemplateShow final : TemplateInspection {
    TemplateShow() : TemplateInspection(true) {}
};

}  // namespace

std::unique_ptr<Operation> make_template_show() { return make<TemplateShow>(); }

}  // namespace ostraka
