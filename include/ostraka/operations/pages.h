// Documentation generated from the table of operations: pages, manuals, shell completion.
#pragma once

#include "ostraka/operations/table.h"

namespace ostraka {

/// Markdown page on all operations whose names begin with `first_word` ("mesh"), or on the single operation with this name
/// ("slice"): inputs, reports, and options with ranges, defaults and units.
std::string command_page(const std::string& first_word);
/// First words of all operation names, in the order of the table of operations; there is one Markdown page for each first word.
std::vector<std::string> command_page_names();

/// Usage line of an operation with its positional arguments in the given order: "ostraka mesh convert INPUT OUTPUT [options]".
std::string usage_of(const Call& call, const std::vector<std::string>& order);

/// Name of the manual page of an operation, such as "ostraka-mesh-info".
std::string manual_name(const OperationEntry& entry);
/// Manual page of an operation in troff format, section 1.
std::string manual_page(const OperationEntry& entry);

/// A flag that the command accepts for every operation.
struct CommonFlag {
    const char* name;  ///< name without leading dashes
    bool has_value;    ///< the flag is followed by a value
};
inline constexpr CommonFlag common_flags[]{{"json", false},   {"show", true},   {"quiet", false},
                                           {"threads", true}, {"memory", true}, {"help", false}};

/// Shells for which a completion script is generated.
enum class Shell { bash, zsh, fish };
/// Completion script of a shell for the command `ostraka`; the script calls `ostraka --complete WORD...`.
std::string completion_script(Shell shell);
/// Completions of the last word of a command line; `words` are the words after `ostraka`. Completions are operation names, flags,
/// choices, tags of the annotation file named by an earlier word, and files of the required kind. Never throws because of a
/// file's content.
std::vector<std::string> completions(const std::vector<std::string>& words);

}  // namespace ostraka
