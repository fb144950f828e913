// The options of this module, one list for each struct.
#include "ostraka/annotation/annotation_file.h"

#include "ostraka/core/options.h"

namespace ostraka {

void ReadAnnotationsOptions::describe(OptionList& visit) {
    visit("force-mesh", force_mesh, "use annotations made for another mesh if their indices and edges fit", Anything{});
}

}  // namespace ostraka
