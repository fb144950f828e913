#include "ostraka/core/error.h"

#include <fmt/core.h>

namespace ostraka {

namespace {
std::string message(const std::string& where, const std::string& problem, const std::string& remedy) {
    std::string text = where.empty() ? problem : fmt::format("{}: {}", where, problem);
    if (!remedy.empty()) text += fmt::format(" ({})", remedy);
    return text;
}
}  // namespace

Error::Error(ErrorKind kind, const std::string& where, const std::string& problem, const std::string& remedy)
    : std::runtime_error(message(where, problem, remedy)), kind_(kind), where_(where), problem_(problem), remedy_(remedy) {}

void fail_input(const std::string& where, const std::string& problem, const std::string& remedy) {
    throw Error(ErrorKind::input, where, problem, remedy);
}

void fail_work(const std::string& where, const std::string& problem, const std::string& remedy) {
    throw Error(ErrorKind::failure, where, problem, remedy);
}

void fail_usage(const std::string& problem, const std::string& remedy) { throw Error(ErrorKind::usage, {}, problem, remedy); }

}  // namespace ostraka
