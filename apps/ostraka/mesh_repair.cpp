#include "command.h"

namespace ostraka::app {

void add_mesh_repair(CLI::App&, Session&) {}

}  // namespace ostraka::app
