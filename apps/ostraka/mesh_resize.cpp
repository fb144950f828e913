#include "command.h"

namespace ostraka::app {

void add_mesh_resize(CLI::App&, Session&) {}

}  // namespace ostraka::app
