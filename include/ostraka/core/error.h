// The error type that all modules throw and `main` reports.
#pragma once

#include <stdexcept>
#include <string>

namespace ostraka {

/// Kind of an error, which determines the exit code.
enum class ErrorKind {
    input,     ///< a file or a mesh is invalid (exit code 1)
    failure,   ///< the computation failed: no disk space, no memory, no solution (exit code 1)
    usage,     ///< the arguments or options are invalid (exit code 2)
    cancelled  ///< the caller cancelled the computation (exit code 130)
};

/// An error for the user: the problem, its location (file, line, element) and the remedy.
class Error : public std::runtime_error {
public:
    Error(ErrorKind kind, const std::string& where, const std::string& problem, const std::string& remedy = {});

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

/// Throws an Error of kind input.
[[noreturn]] void fail_input(const std::string& where, const std::string& problem, const std::string& remedy = {});
/// Throws an Error of kind failure.
[[noreturn]] void fail_work(const std::string& where, const std::string& problem, const std::string& remedy = {});
/// Throws an Error of kind usage.
[[noreturn]] void fail_usage(const std::string& problem, const std::string& remedy = {});

}  // namespace ostraka
