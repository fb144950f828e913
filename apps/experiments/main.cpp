// Experiments: accuracy of annotation transfer, validity of cages, effect of semantic constraints. Each prints Markdown tables
// and writes the raw rows as CSV.
#include "harness.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <iostream>

namespace ostraka::experiments {
namespace {

std::vector<std::string> split_at_commas(const std::vector<std::string>& words) {
    std::vector<std::string> parts;
    for (const std::string& word : words)
        for (std::string& part : CLI::detail::split(word, ',')) parts.push_back(std::move(part));
    return parts;
}

void add_option(CLI::App& command, Option& option) {
    const std::string help = option.help + (option.unit.empty() ? "" : " (" + option.unit + ")");
    if (option.type() == OptionType::boolean) {
        command.add_flag_function(
            "--" + option.name, [&option](std::int64_t count) { option.set(count > 0); }, help);
        return;
    }
    const auto set = [&option](const std::vector<std::string>& words) {
        option.set(option.is_list() && !option.is_positional ? split_at_commas(words) : words);
    };
    CLI::Option* added =
        command.add_option_function<std::vector<std::string>>(option.is_positional ? option.name : "--" + option.name, set, help);
    if (!option.is_list()) added->expected(1)->allow_extra_args(false);
    added->default_str(option.initial)->required(option.needed);
    if (!option.allowed().empty()) added->type_name(option.allowed());
}

int run(int argc, char** argv) {
    CLI::App tool("Experiments on annotation transfer, cages and semantic constraints", "ostraka_experiments");
    tool.require_subcommand(1);
    int threads = 0;
    tool.add_option("--threads", threads, "number of threads, 0 for all cores")->check(CLI::Range(0, 1024));
    std::sort(experiments().begin(), experiments().end(), [](const auto& a, const auto& b) { return a.name < b.name; });
    std::vector<std::pair<CLI::App*, const Experiment*>> commands;
    for (Experiment& experiment : experiments()) {
        CLI::App* command = tool.add_subcommand(experiment.name, experiment.help);
        for (Option& option : experiment.options) add_option(*command, option);
        commands.emplace_back(command, &experiment);
    }
    try {
        tool.parse(argc, argv);
        set_threads(threads);
        for (const auto& [command, experiment] : commands)
            if (command->parsed()) experiment->run();
        return 0;
    } catch (const CLI::ParseError& error) {
        return tool.exit(error) == 0 ? 0 : 2;
    } catch (const Error& error) {
        std::cerr << "ostraka_experiments: " << error.what() << '\n';
        return error.kind() == ErrorKind::usage ? 2 : 1;
    }
}

}  // namespace
}  // namespace ostraka::experiments

int main(int argc, char** argv) { return ostraka::experiments::run(argc, argv); }
