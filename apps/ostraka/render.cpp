#include "command.h"

namespace ostraka::app {

void add_render(CLI::App&, Session&) {}

}  // namespace ostraka::app
