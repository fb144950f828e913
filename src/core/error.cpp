#include "ostraka/core/error.h"

#include "ostraka/core/text.h"

#include <fmt/core.h>

namespace ostraka {

namespace {
std::string message(const std::string& where, const std::string& problem, const std::string& remedy) {
    std::string text = where.empty() ? problem : fmt::format("{}: {}", where, problem);
    if (!remedy.empty()) text += fmt::format(" ({})", remedy);
    return text;
}

/// Text that quotes a file may hold any bytes: runs of bytes that a terminal cannot show become "...", and long texts are cut.
std::string shown(const std::string& text) {
    constexpr std::size_t max_length = 4000;
    std::string result;
    bool in_run = false;
    for (std::size_t position = 0; position < text.size();) {
        if (result.size() > max_length) return result + "...";
        const Character character = character_at(text, position);
        const bool strange = (is_control(character.code) && character.code != '\n' && character.code != '\t') ||
                             (character.code == 0xFFFD && character.length == 1);
        if (strange && !in_run) result += "...";
        if (!strange) result += text.substr(position, character.length);
        in_run = strange;
        position += character.length;
    }
    return result;
}
}  // namespace

Error::Error(ErrorKind kind, const std::string& where, const std::string& problem, const std::string& remedy)
    : std::runtime_error(message(where, shown(problem), shown(remedy))),
      kind_(kind),
      where_(where),
      problem_(shown(problem)),
      remedy_(shown(remedy)) {}

void fail_input(const std::string& where, const std::string& problem, const std::string& remedy) {
    throw Error(ErrorKind::input, where, problem, remedy);
}

void fail_work(const std::string& where, const std::string& problem, const std::string& remedy) {
    throw Error(ErrorKind::failure, where, problem, remedy);
}

void fail_usage(const std::string& problem, const std::string& remedy) { throw Error(ErrorKind::usage, {}, problem, remedy); }

}  // namespace ostraka
