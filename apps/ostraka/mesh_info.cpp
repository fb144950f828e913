#include "command.h"

namespace ostraka::app {

void add_mesh_info(CLI::App&, Session&) {}

}  // namespace ostraka::app
