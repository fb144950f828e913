// The options of this module, one list for each struct.
#include "ostraka/cage/cage.h"

#include "ostraka/core/options.h"

namespace ostraka {

void CageOptions::describe(OptionList& visit) {
    visit("vertices", vertices, "wanted number of vertices", Range{4, 1e6});
    visit("alpha", alpha,
          "what is narrower than this is wrapped over; 0: a fortieth, and more where the wanted number of vertices needs it",
          Range{0, 1}, "share of the diagonal");
    visit("offset", offset, "distance of the wrap from the mesh", Range{1e-4, 0.5}, "share of the diagonal");
    visit("genus", genus,
          "holes through the object: follow (the cage has those that the wrap leaves open) or fill (the cage has none)",
          Choices{"follow", "fill"});
}

}  // namespace ostraka
