// The options of this module, one list for each struct.
#include "ostraka/template_package/template.h"

#include "ostraka/core/options.h"

namespace ostraka {

void TemplateOptions::describe(OptionList& visit) {
    visit("allow-outside", allow_outside, "parts may stand outside the folder of the template", Anything{});
    visit("force-mesh", force_mesh, "take annotations made for another mesh if their indices and edges fit", Anything{});
}

}  // namespace ostraka
