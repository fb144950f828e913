// What is made from the table for people: pages, manuals, completion in a shell.
#pragma once

#include "ostraka/operations/table.h"

namespace ostraka {

/// A Markdown page on the operations whose names begin with this word ("mesh"), or on the one of that name ("slice"): what each
/// takes, its options with ranges, defaults and units, and its report.
std::string commands_page(const std::string& first_word);
/// The first words of all names, in the order of the table: one page each.
std::vector<std::string> command_pages();

/// "ostraka mesh convert INPUT OUTPUT [options]": how an operation is called with its arguments in this order.
std::string usage_of(const Call& call, const std::vector<std::string>& order);

/// "ostraka-mesh-info": a manual page (troff, section 1) on one operation.
std::string manual_name(const OperationEntry& entry);
std::string manual_page(const OperationEntry& entry);

/// Flags that the command has for every operation.
struct CommonFlag {
    const char* name;
    bool has_value;
};
inline constexpr CommonFlag common_flags[]{{"json", false},   {"show", true},   {"quiet", false},
                                           {"threads", true}, {"memory", true}, {"help", false}};

enum class Shell { bash, zsh, fish };
/// What a shell reads to complete the words of `ostraka`: it asks `ostraka --complete WORD...`.
std::string completion_script(Shell shell);
/// What may stand in place of the last of the words that follow `ostraka`: words of names, flags, choices, tags of the annotation
/// file among the words, files of the kind that is wanted. Never throws for what stands in files.
std::vector<std::string> completions(const std::vector<std::string>& words);

}  // namespace ostraka
