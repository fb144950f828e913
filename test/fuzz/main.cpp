// Runs the readers on mutated files of all kinds: they must not crash, hang, use unbounded memory, or access files outside the
// folder. doc/building.md describes its use.
#include "arena.h"
#include "findings.h"

#include "ostraka/core/error.h"
#include "ostraka/core/text.h"

#include <algorithm>
#include <chrono>
#include <iostream>
#include <map>
#include <optional>

namespace ostraka::fuzz {

namespace {

constexpr const char* usage =
    R"(ostraka_fuzz --seed N (--runs K | --seconds S) [--first I] [--kind NAME] [--keep FOLDER] [--limit S]
ostraka_fuzz [--say] [--expected] FILE...   what was kept (or folders of it), once more; --say: with all that it has to say;
                               --expected: what comes of each file is what its name begins with
ostraka_fuzz --kinds           kinds of files
)";

constexpr int left_out = 77;  ///< exit code, as expected by ctest

struct Words {
    std::uint64_t seed = 1, runs = 0, first = 0;
    double seconds = 0, limit = 10;
    std::string kind;
    Path keep;
    bool kinds = false, say = false, expected = false;
    std::vector<Path> files;
};

Words words_of_call(const std::vector<std::string>& given) {
    Words words;
    for (std::size_t i = 0; i < given.size(); ++i) {
        const std::string& flag = given[i];
        if (flag == "--kinds" || flag == "--say" || flag == "--expected") {
            (flag == "--say" ? words.say : flag == "--kinds" ? words.kinds : words.expected) = true;
            continue;
        }
        if (!flag.starts_with("--")) {
            words.files.emplace_back(flag);
            continue;
        }
        if (i + 1 == given.size()) fail_usage("nothing stands behind " + flag, usage);
        const std::string& value = given[++i];
        const auto number = [&] {
            const auto read = number_of(value);
            if (!read || *read < 0) fail_usage(flag + " is followed by '" + value + "'", "give a number");
            return *read;
        };
        if (flag == "--seed") words.seed = static_cast<std::uint64_t>(number());
        else if (flag == "--runs") words.runs = static_cast<std::uint64_t>(number());
        else if (flag == "--first") words.first = static_cast<std::uint64_t>(number());
        else if (flag == "--seconds") words.seconds = number();
        else if (flag == "--limit") words.limit = number();
        else if (flag == "--kind") words.kind = value;
        else if (flag == "--keep") words.keep = value;
        else fail_usage("there is no flag " + flag, usage);
    }
    return words;
}

/// The possible mutations by kind: a subject and one of its targets.
using Kinds = std::map<std::string, std::vector<std::pair<const Subject*, const Target*>>>;

Kinds kinds_of(const std::vector<Subject>& subjects) {
    Kinds kinds;
    for (const Subject& subject : subjects)
        for (const Target& target : subject.targets) kinds[target.kind].emplace_back(&subject, &target);
    return kinds;
}

std::string bytes_of(const Subject& subject, const std::string& file) {
    for (const SubjectFile& subject_file : subject.files)
        if (subject_file.name == file) return subject_file.from.empty() ? subject_file.text : read_file(subject_file.from);
    return {};
}

struct Trial {
    const Subject* subject = nullptr;
    std::string kind;
    std::vector<Change> changes;
};

Change change_of(const Subject& subject, const Target& target, const std::string& other, Dice& dice) {
    const std::string bytes = bytes_of(subject, target.file);
    if (target.kind == "options") return {Change::What::bytes, target.file, mutate_options(bytes, subject.options, dice)};
    if (target.kind == "messages") return {Change::What::bytes, target.file, mutate_lines(bytes, dice)};
    const bool may_lead_out = subject.keeps_inside && !target.by_caller;
    if (dice.once_in(may_lead_out ? 6 : 40)) return replace_file(target.file, may_lead_out, dice);
    if (is_json_name(target.file) && dice.below(4) > 0)
        return {Change::What::bytes, target.file, mutate_json(bytes, subject.plants, dice)};
    return {Change::What::bytes, target.file, mutate_bytes(bytes, other, dice)};
}

Trial trial_of(const Kinds& kinds, const std::string& kind, Dice& dice) {
    Trial trial;
    auto list = kinds.begin();
    if (kind.empty()) std::advance(list, dice.below(kinds.size()));
    else list = kinds.find(kind);
    trial.kind = list->first;
    const auto& [subject, target] = dice.pick(list->second);
    trial.subject = subject;
    const auto& [other, its] = dice.pick(list->second);
    const std::string joined = bytes_of(*other, its->file);
    trial.changes.push_back(change_of(*subject, *target, joined, dice));
    if (dice.once_in(5)) {
        const Target& second = dice.pick(subject->targets);
        if (second.file != target->file) trial.changes.push_back(change_of(*subject, second, joined, dice));
    }
    return trial;
}

/// The number of runs by outcome, and the maximum cost.
struct Tally {
    std::map<Outcome, std::size_t> outcomes;
    std::map<std::string, std::size_t> findings;
    std::size_t runs = 0;
    double slowest = 0, largest = 0;

    void add(const Verdict& verdict, const std::string& kind) {
        ++runs;
        ++outcomes[verdict.outcome];
        if (is_finding(verdict.outcome)) ++findings[kind];
        slowest = std::max(slowest, verdict.seconds);
        largest = std::max(largest, verdict.peak);
    }
    [[nodiscard]] bool is_clean() const { return findings.empty(); }
    void print(double seconds) const {
        std::cout << runs << " runs in " << static_cast<long>(seconds) << " s:";
        for (const Outcome outcome : {Outcome::accepted, Outcome::refused, Outcome::stopped, Outcome::crash, Outcome::hang,
                                      Outcome::memory, Outcome::touched, Outcome::betrayed})
            std::cout << ' ' << (outcomes.contains(outcome) ? outcomes.at(outcome) : 0) << ' ' << to_string(outcome)
                      << (outcome == Outcome::betrayed ? "" : ",");
        std::cout << "; slowest " << slowest << " s, largest " << static_cast<long>(largest / 1e6) << " MB" << std::endl;
        for (const auto& [kind, count] : findings) std::cout << "  " << kind << ": " << count << std::endl;
    }
};

std::string first_lines(const std::string& text) {
    std::string line = text.substr(0, 300);
    std::replace_if(
        line.begin(), line.end(), [](unsigned char c) { return c < 32 || c > 126; }, ' ');
    return line;
}

void tell(const std::string& which, const Trial& trial, const Verdict& verdict, const std::string& output) {
    std::cout << to_string(verdict.outcome) << ": " << which << ", " << trial.kind << ", " << trial.subject->name << " (";
    for (const Change& change : trial.changes) std::cout << change.file << (&change == &trial.changes.back() ? "" : ", ");
    std::cout << "): " << verdict.detail << ", " << verdict.seconds << " s\n    " << first_lines(output) << std::endl;
}

int fuzz(Arena& arena, const Kinds& kinds, const Words& words) {
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    const auto gone = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
    Tally tally;
    for (std::uint64_t run = words.first; words.runs > 0 ? run < words.first + words.runs : gone() < words.seconds; ++run) {
        Dice dice(words.seed, run);
        const Trial trial = trial_of(kinds, words.kind, dice);
        const Verdict verdict = arena.run(*trial.subject, trial.changes, words.limit);
        tally.add(verdict, trial.kind);
        if (verdict.outcome < Outcome::stopped) continue;
        const std::string which = "seed " + std::to_string(words.seed) + ", run " + std::to_string(run);
        tell(which, trial, verdict, arena.output());
        if (words.keep.empty()) continue;
        make_folder(words.keep);
        const std::string name =
            to_string(verdict.outcome) + "-" + std::to_string(words.seed) + "-" + std::to_string(run) + ".json";
        write_finding(words.keep / name, {trial.subject->name, trial.kind, which + ": " + verdict.detail, trial.changes});
    }
    tally.print(gone());
    return tally.is_clean() ? 0 : 1;
}

int repeat(Arena& arena, const std::vector<Subject>& subjects, const Words& words) {
    std::vector<Path> files;
    for (const Path& given : words.files)
        if (!is_folder(given)) files.push_back(given);
        else
            for (const std::string& name : files_in(given))
                if (name.ends_with(".json")) files.push_back(given / name);
    Tally tally;
    bool as_expected = true;
    for (const Path& file : files) {
        if (words.expected && !measures_memory() && file.filename().string().starts_with("memory")) continue;
        const Finding finding = read_finding(file);
        const auto subject =
            std::find_if(subjects.begin(), subjects.end(), [&](const Subject& s) { return s.name == finding.subject; });
        if (subject == subjects.end())
            fail_input(file.string(), "is of a subject '" + finding.subject + "' that there is none of", "take it away");
        const Verdict verdict = arena.run(*subject, finding.changes, words.limit);
        tally.add(verdict, finding.kind);
        tell(file.filename().string(), {&*subject, finding.kind, finding.changes}, verdict, arena.output());
        as_expected = as_expected && file.filename().string().starts_with(to_string(verdict.outcome));
        if (words.say) std::cout << arena.output() << std::endl;
    }
    tally.print(0);
    return (words.expected ? as_expected && !files.empty() : tally.is_clean()) ? 0 : 1;
}

int run(const Words& words) {
    if (words.files.empty() && !words.kinds && words.runs == 0 && words.seconds == 0) fail_usage("nothing to do", usage);
    if (!can_confine()) {
        std::cout << "LEFT OUT: this system cannot keep a process from writing elsewhere (Landlock)" << std::endl;
        return left_out;
    }
    const Path project = OSTRAKA_SOURCE_DIR;
    Arena arena(project);
    const std::vector<Subject> subjects = list_subjects(project, arena.seeds());
    const Kinds kinds = kinds_of(subjects);
    if (words.kinds) {
        for (const auto& [kind, list] : kinds) std::cout << kind << ": " << list.size() << " seeds\n";
        return 0;
    }
    if (!words.kind.empty() && !kinds.contains(words.kind)) fail_usage("there is no kind '" + words.kind + "'", "see --kinds");
    return words.files.empty() ? fuzz(arena, kinds, words) : repeat(arena, subjects, words);
}

}  // namespace

}  // namespace ostraka::fuzz

int main(int argc, char** argv) {
    try {
        return ostraka::fuzz::run(ostraka::fuzz::words_of_call({argv + 1, argv + argc}));
    } catch (const std::exception& error) {
        std::cerr << "ostraka_fuzz: " << error.what() << '\n';
        return 2;
    }
}
