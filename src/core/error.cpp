#include "ostraka/core/error.h"

namespace ostraka {

namespace {
std::string message(const std::string& where, const std::string& what, const std::string& remedy) {
    std::string text = where.empty() ? what : where + ": " + what;
    if (!remedy.empty()) text += " (" + remedy + ")";
    return text;
}
}  // namespace

Error::Error(ErrorKind kind, const std::string& where, const std::string& what, const std::string& remedy)
    : std::runtime_error(message(where, what, remedy)), kind_(kind), where_(where), problem_(what), remedy_(remedy) {}

void fail_input(const std::string& where, const std::string& what, const std::string& remedy) {
    throw Error(ErrorKind::input, where, what, remedy);
}

void fail_work(const std::string& where, const std::string& what, const std::string& remedy) {
    throw Error(ErrorKind::failure, where, what, remedy);
}

void fail_usage(const std::string& what, const std::string& remedy) { throw Error(ErrorKind::usage, {}, what, remedy); }

}  // namespace ostraka
