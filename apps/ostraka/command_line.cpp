// Operations as commands.
#include "command_line.h"

#include "signals.h"
#include "workbench.h"

#include "ostraka/core/message_text.h"
#include "ostraka/core/nearest_name.h"
#include "ostraka/core/text.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/files/file.h"
#include "ostraka/operations/pages.h"
#include "ostraka/operations/table.h"

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <iostream>
#include <map>

namespace ostraka::app {

namespace {

std::vector<std::string> split_words(const std::string& name) {
    std::vector<std::string> words;
    std::istringstream stream(name);
    for (std::string word; stream >> word;) words.push_back(word);
    return words;
}

/// Whether a flag takes a value.
enum class FlagValue { unknown, none, one };

bool begins_a_flag(const std::string& word) {
    return word.size() > 1 && word[0] == '-' && !number_of(word) && std::isdigit(static_cast<unsigned char>(word[1])) == 0;
}
std::string name_of_flag(const std::string& word) {
    const std::size_t begin = std::min(word.find_first_not_of('-'), word.size());
    return word.substr(begin, word.find('=') - begin);
}

FlagValue value_of_flag(const Call& call, const std::string& name) {
    for (const CommonFlag& common : common_flags)
        if (name == common.name) return common.has_value ? FlagValue::one : FlagValue::none;
    for (const Option& option : call.parameters().options) {
        if (option.is_positional) continue;
        const bool is_switch = option.type() == OptionType::boolean;
        if (option.name == name) return is_switch ? FlagValue::none : FlagValue::one;
        if (is_switch && option.initial == "true" && name == "no-" + option.name) return FlagValue::none;
    }
    const Slot* slot = call.parameters().slot(name);
    return slot == nullptr || slot->is_positional ? FlagValue::unknown : FlagValue::one;
}

/// Throws with the nearest option, of the operation or common to all.
[[noreturn]] void refuse_option(const Call& call, const std::string& name) {
    const Slot* slot = call.parameters().slot(name);
    if (slot != nullptr && slot->is_positional)
        throw Error(ErrorKind::usage, call.entry().name, name + " is given without a flag",
                    fmt::format("'ostraka {} --help' shows the order", call.entry().name));
    std::vector<std::string> names;
    for (const CommonFlag& common : common_flags) names.emplace_back(common.name);
    for (const Option& option : call.parameters().options)
        if (option.type() == OptionType::boolean && option.initial == "true") names.push_back("no-" + option.name);
    call.no_such_name(name, names);
}

/// Checks and normalises the words after the operation's name for the parser: every flag is known and has its value. A word
/// equal to a flag can be a value only after "=", and a positional argument can begin with a dash only after "--".
std::vector<std::string> checked_words(Call& call, const std::vector<std::string>& words) {
    const auto refuse = [&](const std::string& problem, const std::string& remedy) {
        throw Error(ErrorKind::usage, call.entry().name, problem, remedy);
    };
    std::vector<std::string> checked, arguments;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string& word = words[i];
        if (word == "--") {
            // A positional option that takes several words, such as the command line of another program, gets them unchanged.
            for (Option& option : call.parameters().options)
                if (option.is_positional && option.takes_words && i + 1 < words.size()) {
                    option.set(std::vector(words.begin() + static_cast<long>(i) + 1, words.end()));
                    return checked;
                }
            for (std::size_t k = i + 1; k < words.size(); ++k)
                arguments.push_back(begins_a_flag(words[k]) ? "./" + words[k] : words[k]);
            break;
        }
        checked.push_back(word);
        if (word == "-h" || !begins_a_flag(word)) continue;
        const std::string name = name_of_flag(word);
        const FlagValue value = word.starts_with("--") ? value_of_flag(call, name) : FlagValue::unknown;
        if (value == FlagValue::unknown && file_exists(word))
            refuse(fmt::format("'{}' is read as an option", printable(word, 60)), "write ./" + printable(word, 60));
        if (value == FlagValue::unknown) refuse_option(call, name);
        const std::size_t equals = word.find('=');
        if (value == FlagValue::none) {
            if (equals == std::string::npos) continue;
            const std::string switch_value = word.substr(equals + 1);
            if (switch_value != "true" && switch_value != "false")
                refuse(fmt::format("--{} is '{}'", name, printable(switch_value, 60)),
                       fmt::format("give --{} alone, or =true or =false", name));
        } else if (equals != std::string::npos) {
            // The parser would take the next word for an empty value.
            if (equals + 1 == word.size()) checked.back().pop_back(), checked.emplace_back();
        } else if (i + 1 == words.size() ||
                   (begins_a_flag(words[i + 1]) && value_of_flag(call, name_of_flag(words[i + 1])) != FlagValue::unknown)) {
            refuse(fmt::format("--{} has no value", name),
                   i + 1 == words.size() ? "give it one"
                                         : fmt::format("give it one; --{}={} for that word", name, printable(words[i + 1], 40)));
        } else {
            checked.push_back(words[++i]);
        }
    }
    checked.insert(checked.end(), arguments.begin(), arguments.end());
    return checked;
}

/// Sets a file; names of in-memory files are rejected on the command line.
void set_file(Call& call, const std::string& name, const std::string& file) {
    if (is_memory(file))
        throw Error(ErrorKind::usage, call.entry().name,
                    fmt::format("{} is '{}', which is for programs", name, printable(file, 60)),
                    fmt::format("write ./{} for a file of that name", printable(file, 60)));
    call.set_file(name, file);
}

bool is_group(const std::string& path) {
    const auto groups = operation_groups();
    return std::any_of(groups.begin(), groups.end(), [&](const OperationGroup& group) { return group.name == path; });
}

/// Converts "help" before the words of a command, or after those of a group, to a trailing --help.
std::vector<std::string> with_help_as_flag(std::vector<std::string> words) {
    if (!words.empty() && words.front() == "help") {
        words.erase(words.begin());
        words.emplace_back("--help");
    } else if (words.size() > 1 && words.back() == "help" && is_group(joined(std::vector(words.begin(), words.end() - 1), " "))) {
        words.back() = "--help";
    }
    return words;
}

/// The operation named by the first arguments; null if they name a group or are empty. Throws if they name neither.
const OperationEntry* named_operation(const std::vector<std::string>& arguments) {
    std::vector<std::string> command_words;
    for (const std::string& word : arguments)
        if (word.starts_with("-")) break;
        else command_words.push_back(word);
    const OperationEntry* best = nullptr;
    std::size_t maximum = 0, max_matching = 0;
    std::vector<std::string> next_words;  // possible next words
    for (const OperationEntry& entry : operations()) {
        const auto words = split_words(entry.name);
        std::size_t matching = 0;
        while (matching < words.size() && matching < command_words.size() && words[matching] == command_words[matching])
            ++matching;
        if (matching == words.size() && matching > maximum) best = &entry, maximum = matching;
        if (matching > max_matching) max_matching = matching, next_words.clear();
        if (matching == max_matching && matching < words.size()) next_words.push_back(words[matching]);
    }
    if (best == nullptr && max_matching < command_words.size()) {
        std::string prefix;
        for (std::size_t i = 0; i < max_matching; ++i) prefix += " " + command_words[i];
        if (max_matching == 0) next_words.emplace_back("workbench");
        // "template turn" became "template revolve" in version 0.2.
        const bool is_former_name = max_matching == 1 && command_words[0] == "template" && command_words[1] == "turn";
        const std::string nearest = is_former_name ? "revolve" : nearest_name(command_words[max_matching], next_words);
        fail_usage(
            fmt::format("'{}' is not a command{}", printable(command_words[max_matching], 60),
                        max_matching == 0 ? "" : fmt::format(" of 'ostraka{}'", prefix)),
            nearest.empty() ? fmt::format("'ostraka{} --help' shows them", prefix) : fmt::format("did you mean '{}'?", nearest));
    }
    return best;
}

std::string type_of(const Option& option) {
    static constexpr const char* types[]{"", "INT", "FLOAT", "TEXT", "TEXT", "TEXT", "FLOATS", "INTS"};
    std::string text = types[static_cast<std::size_t>(option.type())];
    if (const auto names = option.names(); !names.empty()) text = fmt::format("{{{}}}", joined(names, ","));
    if (const auto* words = std::get_if<Words>(&option.rule); words != nullptr && !words->others.empty())
        text += " or " + words->others;
    if (const auto* range = std::get_if<Range>(&option.rule))
        text += fmt::format(" in [{}, {}]", digits(range->min, 6), digits(range->max, 6));
    return text;
}

void add_option(CLI::App& command, Option& option) {
    const std::string flag = "--" + option.name,
                      help = option.help + (option.unit.empty() ? "" : fmt::format(" ({})", option.unit));
    CLI::Option* cli_option = nullptr;
    if (option.type() == OptionType::boolean) {
        const bool is_on = option.initial == "true";
        const auto set = [&option](std::int64_t count) { option.set(count > 0); };
        cli_option =
            command.add_flag_function(flag, set, is_on ? fmt::format("{}; on unless --no-{} is given", help, option.name) : help);
        if (is_on) command.add_flag_function("!--no-" + option.name, set)->group("");
    } else {
        cli_option = command.add_option_function<std::vector<std::string>>(
            option.is_positional ? option.name : flag, [&option](const std::vector<std::string>& words) { option.set(words); },
            help);
        cli_option->type_name(type_of(option))->expected(1);
        if (option.is_list())
            cli_option->expected(1, option.takes_words ? 1'000'000 : 1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
        cli_option->allow_extra_args(option.takes_words);
        const OptionType type = option.type();
        if (type == OptionType::integer || type == OptionType::number) {
            if (!option.initial.empty()) cli_option->default_str(digits(std::stod(option.initial)));
        } else if (!option.initial.empty()) {
            cli_option->default_str(option.initial);
        }
    }
    if (option.needed) cli_option->required();
    if (!option.group.empty()) cli_option->group(option.group);
}

void add_slot(CLI::App& command, Call& call, const Slot& slot) {
    const std::string name = slot.name;
    auto* cli_option = command.add_option_function<std::vector<std::string>>(
        slot.is_positional ? name : "--" + name,
        [&call, name](const std::vector<std::string>& files) {
            for (const auto& file : files) set_file(call, name, file);
        },
        slot.help);
    cli_option->type_name("FILE");
    if (slot.repeated) cli_option->expected(slot.is_positional ? -1 : 1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    else cli_option->expected(1);
    cli_option->allow_extra_args(slot.takes_words || (slot.is_positional && slot.repeated));
    if (slot.repeated && slot.takes_words) cli_option->expected(1, 1'000'000);
    if (slot.needed) cli_option->required();
}

bool is_repeated(Call& call, const std::string& name) {
    const Slot* slot = call.parameters().slot(name);
    return slot != nullptr ? slot->repeated : call.parameters().options.find(name)->is_list();
}

std::string shown_order(Call& call, std::vector<std::string> order) {
    for (auto& name : order) name += is_repeated(call, name) ? " ..." : "";
    return joined(order, " ");
}

/// Help for positional arguments with several orders, which the parser treats as one list.
class OrdersFormatter final : public CLI::Formatter {
public:
    explicit OrdersFormatter(Call& call) : call_(call) {}

    std::string make_usage(const CLI::App* /*app*/, std::string name) const override {
        std::string text;
        for (const auto& order : call_.parameters().orders)
            text += fmt::format("{}{} [OPTIONS] {}\n", text.empty() ? "Usage: " : "       ", name, shown_order(call_, order));
        return text;
    }
    std::string make_positionals(const CLI::App* /*app*/) const override {
        std::ostringstream text;
        text << "\nPositionals:\n";
        const auto add = [&](const std::string& name, const std::string& value_type, const std::string& help) {
            if (call_.parameters().in_some_order(name))
                CLI::detail::format_help(text, fmt::format("{} {}{}", name, value_type, is_repeated(call_, name) ? " ..." : ""),
                                         help, column_width_);
        };
        for (const Slot* slot : call_.parameters().slots()) add(slot->name, "FILE", slot->help);
        for (const Option& option : call_.parameters().options) add(option.name, type_of(option), option.help);
        return text.str();
    }

private:
    Call& call_;
};

/// Number of files whose extension fits the slot they would fill.
std::size_t matching_extensions(Call& call, const std::vector<std::string>& order, const std::vector<std::string>& files) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < std::min(order.size(), files.size()); ++i) {
        const Slot* slot = call.parameters().slot(order[i]);
        if (slot == nullptr) continue;
        const std::string file = lower_case(files[i]);
        const auto endings = extensions_of(slot->kind);
        count += std::any_of(endings.begin(), endings.end(), [&](const auto& ending) { return file.ends_with(ending); }) ? 1 : 0;
    }
    return count;
}

/// Assigns positional arguments. The order is selected by their number and, among orders of equal length, by the file
/// extensions.
void take_positionals(Call& call, const std::vector<std::string>& words) {
    const auto& orders = call.parameters().orders;
    const auto fits = [&](const std::vector<std::string>& order) {
        const bool is_open = std::any_of(order.begin(), order.end(), [&](const auto& name) { return is_repeated(call, name); });
        return is_open ? words.size() >= order.size() : words.size() == order.size();
    };
    auto order = orders.end();
    for (auto candidate = orders.begin(); candidate != orders.end(); ++candidate)
        if (fits(*candidate) &&
            (order == orders.end() || matching_extensions(call, *candidate, words) > matching_extensions(call, *order, words)))
            order = candidate;
    if (order == orders.end()) {
        std::vector<std::string> accepted_orders;
        for (const auto& candidate : orders) accepted_orders.push_back(shown_order(call, candidate));
        throw Error(ErrorKind::usage, call.entry().name,
                    fmt::format("{} {} given", counted(words.size(), "argument"), words.size() == 1 ? "is" : "are"),
                    "give " + joined(accepted_orders, ", or "));
    }
    std::size_t position = 0;
    for (std::size_t i = 0; i < order->size(); ++i) {
        const std::size_t count = is_repeated(call, (*order)[i]) ? words.size() - order->size() + 1 : 1;
        const std::vector<std::string> arguments(words.begin() + static_cast<long>(position),
                                                 words.begin() + static_cast<long>(position + count));
        if (call.parameters().slot((*order)[i]) != nullptr)
            for (const auto& file : arguments) set_file(call, (*order)[i], file);
        else call.option((*order)[i]).set(arguments);
        position += count;
    }
}

/// Throws for the first missing required argument, and explains how to give it.
void refuse_missing(const Call& call) {
    const Parameters& parameters = call.parameters();
    const auto refuse = [&](const std::string& name, const std::string& help, const char* value) {
        const bool is_flag = !parameters.in_some_order(name);
        throw Error(ErrorKind::usage, call.entry().name, fmt::format("{}{} is missing", is_flag ? "--" : "", name),
                    fmt::format("give the {}: {}", help,
                                is_flag ? fmt::format("--{} {}", name, value) : usage_of(call, parameters.orders.front())));
    };
    for (const Slot* slot : parameters.slots())
        if (slot->needed && slot->sources.empty()) refuse(slot->name, slot->help, "FILE");
    for (const Option& option : parameters.options)
        if (option.needed && !option.given) refuse(option.name, option.help, "VALUE");
}

/// Throws for a superfluous argument; the remedy names the flag to which a file may belong.
[[noreturn]] void refuse_extra(const Call& call, const std::string& word) {
    std::string remedy = fmt::format("'ostraka {} --help' shows what it takes", call.entry().name);
    for (const Slot* slot : call.parameters().slots()) {
        const auto endings = extensions_of(slot->kind);
        if (!slot->is_positional && slot->role == Role::input && (slot->sources.empty() || slot->repeated) &&
            std::any_of(endings.begin(), endings.end(), [&](const auto& ending) { return word.ends_with(ending); }))
            remedy = fmt::format("give it as --{} {}", slot->name, printable(word, 60));
    }
    throw Error(ErrorKind::usage, call.entry().name, fmt::format("'{}' is one argument too many", printable(word, 60)), remedy);
}

/// Flags common to all commands.
struct Common {
    bool json = false, quiet = false;
    std::string show = "table";
    int threads = 0;
    double memory = 0;
};

/// Declares the operation's flags. Returns true if positional arguments are collected in `words` for `take_positionals`.
bool add_parameters(CLI::App& command, Call& call, std::vector<std::string>& words) {
    Parameters& parameters = call.parameters();
    const auto& orders = parameters.orders;
    bool plain = orders.size() == 1;
    if (plain)
        for (std::size_t i = 0; i + 1 < orders[0].size(); ++i) plain = plain && !is_repeated(call, orders[0][i]);
    if (plain) {
        for (const auto& name : orders[0])
            if (const Slot* slot = parameters.slot(name)) add_slot(command, call, *slot);
            else add_option(command, *parameters.options.find(name));
    } else {
        command.add_option("files", words);
        command.formatter(std::make_shared<OrdersFormatter>(call));
    }
    for (const Slot* slot : parameters.slots())
        if (!parameters.in_some_order(slot->name)) add_slot(command, call, *slot);
    for (Option& option : parameters.options)
        if (!parameters.in_some_order(option.name)) add_option(command, option);
    return !plain;
}

void check_standard_output() {
    std::cout.flush();
    if (!std::cout)
        throw Error(ErrorKind::failure, "standard output", "cannot be written", "free some space, or repair the pipe");
}

/// Limits the address space, so that allocations beyond the limit fail with an error even if the estimate of an operation was
/// too low. Thread stacks are added to the limit, because the system counts them although they are hardly used.
void limit_allocations(double bytes) {
    rlimit limit{};
    if (bytes <= 0 || ::getrlimit(RLIMIT_DATA, &limit) != 0) return;
    rlimit stack{};
    constexpr rlim_t usual_stack = rlim_t{8} << 20;
    const bool is_known = ::getrlimit(RLIMIT_STACK, &stack) == 0 && stack.rlim_cur != RLIM_INFINITY;
    const rlim_t stacks = (static_cast<rlim_t>(threads()) + 4) * (is_known ? stack.rlim_cur : usual_stack);
    limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, static_cast<rlim_t>(bytes) + stacks);
    ::setrlimit(RLIMIT_DATA, &limit);
}

int run_call(Call& call, const Common& common) {
    set_threads(common.threads);
    Context context;
    const bool draws = !common.quiet && ::isatty(2) != 0;
    if (!common.quiet) context.on_note = [](const std::string& text) { std::cerr << "note: " << printable(text) << '\n'; };
    if (draws)
        context.watch.on_progress = [](const std::string& phase, double share) {
            if (share < 1) std::fprintf(stderr, "\r%s %3d %%\033[K", phase.c_str(), static_cast<int>(100 * share));
            else std::fprintf(stderr, "\r\033[K");
        };
    context.watch.memory_limit = common.memory * 1e9;
    limit_allocations(context.watch.memory_limit);
    const Signals signals;
    signals.stop([&context] { context.watch.cancel(); });
    bool has_text = false;
    const auto show = [&](const Report& report) {
        const ReportFormat format = common.json || common.show == "json" ? ReportFormat::json
                                    : common.show == "csv"               ? ReportFormat::csv
                                    : common.show == "markdown"          ? ReportFormat::markdown
                                                                         : ReportFormat::table;
        const std::string text = report.to_text(format);
        has_text = !text.empty();
        std::cout << text;
        // If the report could not be printed, no file is replaced.
        check_standard_output();
    };
    const Report report = call.run(context, show);
    if (!common.quiet && has_text)
        if (const std::string times = report.times(); !times.empty()) std::cerr << "time: " << times << '\n';
    return report.holds() ? done : answer_is_no;
}

}  // namespace

int run_command_line(int argc, char** argv) {
    if (argc > 1 && std::string_view(argv[1]) == "--complete") {  // called by shell completion
        for (const std::string& word : completions({argv + 2, argv + argc})) std::cout << printable(word) << '\n';
        return done;
    }
    CLI::App tool("Semantics-aware modelling of 3D shapes", "ostraka");
    tool.set_version_flag("--version", version());
    tool.require_subcommand(1);
    Common common;
    std::vector<std::string> words;
    bool collects_words = false;
    std::unique_ptr<Call> call;
    CLI::App* running = nullptr;
    std::vector<std::string> arguments = with_help_as_flag({argv + 1, argv + argc});
    if (!arguments.empty() && arguments.front() == "workbench") return run_workbench({arguments.begin() + 1, arguments.end()});
    const OperationEntry* requested_entry = named_operation(arguments);
    std::map<std::string, CLI::App*> known_groups;
    const auto group_of = [&](CLI::App& parent, const std::string& path, const std::string& word) {
        CLI::App*& group = known_groups[path];
        if (group != nullptr) return group;
        const auto groups = operation_groups();
        const auto group_entry =
            std::find_if(groups.begin(), groups.end(), [&](const OperationGroup& candidate) { return candidate.name == path; });
        group = parent.add_subcommand(word, group_entry == groups.end() ? "" : group_entry->help);
        group->require_subcommand(1);
        return group;
    };
    for (const OperationEntry& entry : operations()) {
        CLI::App* parent = &tool;
        const auto parts = split_words(entry.name);
        std::string path;
        for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
            path += (path.empty() ? "" : " ") + parts[i];
            parent = group_of(*parent, path, parts[i]);
        }
        CLI::App* command = parent->add_subcommand(parts.back(), entry.help);
        if (&entry != requested_entry) continue;
        running = command;
        call = std::make_unique<Call>(entry);
        command->add_flag("--json", common.json, "print the report for machines instead of tables");
        command->add_option("--show", common.show, "how the report is printed")
            ->check(CLI::IsMember({"table", "json", "csv", "markdown"}))
            ->capture_default_str();
        command->add_flag("--quiet", common.quiet, "no notes and no progress bar");
        command->add_option("--threads", common.threads, "number of threads, 0 for all cores; results do not depend on it")
            ->check(CLI::Range(0, 1024));
        command->add_option("--memory", common.memory, "memory limit of the work [GB]; 0: the memory of the machine")
            ->check(CLI::Range(0.0, 1e6));
        collects_words = add_parameters(*command, *call, words);
        command->allow_extras();
    }
    tool.add_subcommand("workbench", workbench_help);
    if (call) {
        const auto after_command = arguments.begin() + static_cast<long>(split_words(call->entry().name).size());
        const std::vector<std::string> checked = checked_words(*call, {after_command, arguments.end()});
        arguments.erase(after_command, arguments.end());
        arguments.insert(arguments.end(), checked.begin(), checked.end());
    } else if (!arguments.empty() && arguments[0].starts_with("-") && arguments[0] != "-h" && arguments[0] != "--help" &&
               arguments[0] != "--version") {
        fail_usage(fmt::format("'{}' precedes the command", printable(arguments[0], 60)),
                   "flags follow it: ostraka mesh info FILE --json");
    }
    try {
        std::reverse(arguments.begin(), arguments.end());  // the parser expects reverse order
        tool.parse(arguments);
    } catch (const CLI::ParseError& error) {
        if (call && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) refuse_missing(*call);
        if (error.get_exit_code() != 0 && call)
            throw Error(ErrorKind::usage, call->entry().name, error.what(),
                        fmt::format("'ostraka {} --help' shows what it takes", call->entry().name));
        if (tool.exit(error) != 0) return wrong_usage;
        std::cout.flush();
        return std::cout ? done : failed;
    }
    if (running == nullptr) return wrong_usage;
    for (const std::string& extra : running->remaining()) refuse_extra(*call, extra);
    if (collects_words) take_positionals(*call, words);
    refuse_missing(*call);
    return run_call(*call, common);
}

}  // namespace ostraka::app
