#include "command.h"

namespace ostraka::app {

void add_annotation(CLI::App&, Session&) {}

}  // namespace ostraka::app
