// Documentation generated from the table of operations: pages, manuals, shell completion.
#pragma once

#include "ostraka/operations/table.h"

namespace ostraka {

/// Markdown page on all operations whose names begin with `first_word` ("mesh"), or on the one with this name ("slice"):
/// inputs, options with ranges, defaults and units, and reports.
std::string commands_page(const std::string& first_word);
/// First words of all operation names, in the order of the table; there is one page for each.
std::vector<std::string> command_pages();

/// Usage line with the arguments in this order: "ostraka mesh convert INPUT OUTPUT [options]".
std::string usage_of(const Call& call, const std::vector<std::string>& order);

/// Name of the manual page of an operation: "ostraka-mesh-info"; the page is in troff format, section 1.
std::string manual_name(const OperationEntry& entry);
std::string manual_page(const OperationEntry& entry);

/// Flags that the command accepts for every operation.
struct CommonFlag {
    const char* name;
    bool has_value;
};
inline constexpr CommonFlag common_flags[]{{"json", false},   {"show", true},   {"quiet", false},
                                           {"threads", true}, {"memory", true}, {"help", false}};

enum class Shell { bash, zsh, fish };
/// Completion script of a shell for `ostraka`; it calls `ostraka --complete WORD...`.
std::string completion_script(Shell shell);
/// Completions of the last of the words that follow `ostraka`: operation names, flags, choices, tags of the annotation file
/// among the words, and files of the required kind. Never throws because of a file's content.
std::vector<std::string> completions(const std::vector<std::string>& words);

}  // namespace ostraka
