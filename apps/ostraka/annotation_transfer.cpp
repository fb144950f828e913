#include "command.h"

namespace ostraka::app {

void add_annotation_transfer(CLI::App&, Session&) {}

}  // namespace ostraka::app
