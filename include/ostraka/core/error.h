// The typed error every module throws and `main` alone catches.
#pragma once

#include <stdexcept>
#include <string>

namespace ostraka {

enum class ErrorKind {
    input,     ///< a file or a mesh is not what it should be (exit code 1)
    failure,   ///< the work could not be done: no space, no memory, no solution (exit code 1)
    usage,     ///< the caller's words or options do not make sense (exit code 2)
    cancelled  ///< the caller wanted the work to stop (exit code 130)
};

/// What went wrong, where (file, line, element), and the remedy.
class Error : public std::runtime_error {
public:
    Error(ErrorKind kind, const std::string& where, const std::string& what, const std::string& remedy = {});

    [[nodiscard]] ErrorKind kind() const { return kind_; }
    [[nodiscard]] const std::string& where() const { return where_; }
    [[nodiscard]] const std::string& problem() const { return problem_; }
    [[nodiscard]] const std::string& remedy() const { return remedy_; }

private:
    ErrorKind kind_;
    std::string where_;
    std::string problem_;
    std::string remedy_;
};

/// Shorthands, so that a check stays on one line.
[[noreturn]] void fail_input(const std::string& where, const std::string& what, const std::string& remedy = {});
[[noreturn]] void fail_work(const std::string& where, const std::string& what, const std::string& remedy = {});
[[noreturn]] void fail_usage(const std::string& what, const std::string& remedy = {});

}  // namespace ostraka
