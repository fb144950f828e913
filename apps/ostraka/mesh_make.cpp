#include "command.h"

namespace ostraka::app {

void add_mesh_make(CLI::App&, Session&) {}

}  // namespace ostraka::app
