#include "ostraka/workflow/run.h"

#include "run_folder.h"

#include "ostraka/core/child_process.h"
#include "ostraka/core/json_build.h"
#include "ostraka/core/memory.h"
#include "ostraka/core/parallel.h"
#include "ostraka/core/safe_path.h"
#include "ostraka/core/stopwatch.h"
#include "ostraka/core/transaction.h"
#include "ostraka/core/words.h"
#include "ostraka/operation/object_files.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <ctime>
#include <set>
#include <thread>

namespace ostraka {

namespace {

std::string now_text() {
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    ::gmtime_r(&now, &parts);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
    return text;
}

/// State of an instance.
struct Work {
    enum class Stage { waiting, queued, running, final } stage = Stage::waiting;
    bool selected = false;
    bool again = false;               ///< runs although it is done: its outputs are needed in memory
    std::size_t open_needs = 0;       ///< number of unfinished instances that it needs
    std::size_t open_takers = 0;      ///< number of unfinished instances that need it
    std::vector<std::size_t> takers;  ///< instances that need it
    std::map<std::string, Object> objects;
    std::unique_ptr<Context> context;  ///< context in which the objects are made
    double expected = -1;              ///< duration of an earlier run in seconds; negative: unknown
    std::size_t input_bytes = 0;
};

class Runner {
public:
    Runner(const StudyPlan& plan, Path folder, const RunStudyOptions& options)
        : plan_(plan),
          folder_(std::move(folder)),
          options_(options),
          works_(plan.instances.size()),
          results_(plan.instances.size()) {
        select();
        for (std::size_t i = 0; i < works_.size(); ++i)
            for (const std::size_t need : plan_.instances[i].needs) {
                if (!works_[i].selected) continue;
                works_[need].takers.push_back(i);
                ++works_[need].open_takers;
                ++works_[i].open_needs;
            }
        for (std::size_t i = 0; i < works_.size(); ++i) {
            if (!works_[i].selected) continue;
            ++selected_;
            for (const StudyInput& input : plan_.instances[i].inputs)
                if (!input.file.empty()) {
                    if (file_uses_[input.file]++ == 0) stamps_[input.file] = stamp_of(input.file);
                    works_[i].input_bytes += size_of_file(input.file);
                }
            if (works_[i].open_needs == 0) to_consider_.insert(i);
        }
    }

    std::vector<InstanceResult> run() {
        std::unique_lock lock(mutex_);
        Watch* const watch = current_watch();
        bool cancelled = false;
        for (;;) {
            while (!cancelled && !to_consider_.empty()) {
                const std::size_t i = *to_consider_.begin();
                to_consider_.erase(to_consider_.begin());
                consider(i, lock);
                while (start_next()) {
                }
                cancelled = watch != nullptr && watch->is_cancelled();
            }
            while (!cancelled && start_next()) {
            }
            join_ended(lock);
            if (running_ == 0 && (cancelled || (to_consider_.empty() && queue_.empty()))) break;
            changed_.wait_for(lock, std::chrono::milliseconds(100));
            if (watch == nullptr) continue;
            cancelled = cancelled || watch->is_cancelled();
            if (cancelled)
                for (const auto& [i, thread] : workers_)
                    if (works_[i].context) works_[i].context->watch.cancel();
            tell(*watch);
        }
        join_ended(lock);
        if (cancelled)
            throw Error(ErrorKind::cancelled, "", "cancelled", "what is done is kept: the same command goes on from there");
        if (!options_.dry_run) fail_changed();
        return std::move(results_);
    }

private:
    const StudyInstance& instance(std::size_t i) const { return plan_.instances[i]; }
    Path folder_of(std::size_t i) const { return folder_ / instance(i).folder; }

    /// Selects the requested instances and their dependencies.
    void select() {
        std::vector<std::size_t> wanted;
        std::vector<bool> is_taken(works_.size(), false);
        for (const StudyInstance& one : plan_.instances)
            for (const std::size_t need : one.needs) is_taken[need] = true;
        for (std::size_t i = 0, leaf = 0; i < works_.size(); ++i) {
            const std::string& name = plan_.study.steps[instance(i).step].name;
            if (!options_.only.empty() && std::find(options_.only.begin(), options_.only.end(), name) == options_.only.end())
                continue;
            if (!options_.share.is_whole() && (is_taken[i] || !options_.share.has(leaf++))) continue;
            wanted.push_back(i);
        }
        while (!wanted.empty()) {
            const std::size_t i = wanted.back();
            wanted.pop_back();
            if (works_[i].selected) continue;
            works_[i].selected = true;
            wanted.insert(wanted.end(), instance(i).needs.begin(), instance(i).needs.end());
        }
    }

    bool is_there(std::size_t i, const std::string& output) const {
        const Work& work = works_[i];
        if (work.objects.contains(output)) return true;
        const auto& outputs = results_[i].record.outputs;
        const auto known = outputs.find(output);
        return known != outputs.end() && known->second.kept;
    }

    /// Decides about an instance whose dependencies are finished: up to date, skipped, queued, or waiting for one that runs
    /// again.
    void consider(std::size_t i, std::unique_lock<std::mutex>& lock) {
        Work& work = works_[i];
        InstanceResult& result = results_[i];
        if (work.stage != Work::Stage::waiting) return;
        for (const std::size_t need : instance(i).needs) {
            const InstanceState state = results_[need].state;
            if (state == InstanceState::failed || state == InstanceState::skipped) {
                result.problem = plan_.instances[need].title(plan_.study) + " did not succeed";
                return finish(i, InstanceState::skipped);
            }
            if (state == InstanceState::would_run) {
                result.why = "it takes what " + plan_.instances[need].title(plan_.study) + " would make";
                return finish(i, InstanceState::would_run);
            }
        }
        if (!work.again) {
            try {
                lock.unlock();  // checksums of large files take time
                const auto known = read_record(folder_of(i));
                // Without a record, files are read by the instances that need them, which also yields their checksums.
                std::vector<std::pair<std::string, std::string>> depends;
                if (known) depends = dependencies_of(i);
                std::string why = why_again(plan_, known, depends, instance(i), folder_, checksums_);
                if (why.empty() && options_.again) why = "all is to run again";
                lock.lock();
                if (known) work.expected = known->seconds;
                if (why.empty()) {
                    result.record = *known;
                    return finish(i, InstanceState::unchanged);
                }
                result.record.depends = std::move(depends);
                result.why = std::move(why);
            } catch (const Error& error) {
                if (!lock.owns_lock()) lock.lock();
                result.problem = error.what();
                return finish(i, InstanceState::failed);
            }
            if (options_.dry_run) return finish(i, InstanceState::would_run);
        }
        bool complete = true;
        for (const StudyInput& input : instance(i).inputs) {
            if (input.instance == no_instance || is_there(input.instance, input.output)) continue;
            complete = false;
            Work& other = works_[input.instance];
            if (other.stage != Work::Stage::final) continue;
            other.stage = Work::Stage::waiting;
            other.again = true;
            // Keep its inputs until it has run again.
            for (const std::size_t need : instance(input.instance).needs) ++works_[need].open_takers;
            results_[input.instance].why = "what it makes is needed again by " + instance(i).title(plan_.study);
            to_consider_.insert(input.instance);
        }
        if (!complete) return;  // will be considered again
        work.stage = Work::Stage::queued;
        queue_.push_back(i);
    }

    std::vector<std::pair<std::string, std::string>> dependencies_of(std::size_t i) {
        std::map<std::size_t, StudyRecord> needs;
        {
            const std::lock_guard lock(mutex_);
            for (const std::size_t need : instance(i).needs) needs.emplace(need, results_[need].record);
        }
        return dependencies(
            plan_, instance(i), [&](std::size_t need) -> const StudyRecord& { return needs.at(need); }, checksums_,
            options_.program_folder);
    }

    void finish(std::size_t i, InstanceState state) {
        Work& work = works_[i];
        const bool first = !work.again;
        work.again = false;
        work.stage = Work::Stage::final;
        results_[i].state = state;
        if (first) {
            ++finished_;
            for (const StudyInput& input : instance(i).inputs)
                if (!input.file.empty() && --file_uses_[input.file] == 0) root_.forget(input.file);
        }
        for (const std::size_t need : instance(i).needs) {
            if (--works_[need].open_takers == 0) release(need);
        }
        if (work.open_takers == 0) release(i);
        else if (state != InstanceState::done) works_[i].context.reset();
        for (const std::size_t taker : work.takers) {
            if (first) --works_[taker].open_needs;
            if (works_[taker].open_needs == 0 && works_[taker].stage == Work::Stage::waiting) to_consider_.insert(taker);
        }
    }

    void release(std::size_t i) {
        works_[i].objects.clear();
        works_[i].context.reset();
    }

    /// Starts a queued instance if threads and memory are available.
    bool start_next() {
        if (queue_.empty() || running_ >= static_cast<std::size_t>(threads())) return false;
        const std::size_t i = queue_.front();
        // A mesh in memory with its search trees takes about a dozen times the size of its file.
        const Watch* watch = current_watch();
        const double limit = watch != nullptr ? watch->memory_limit : 0;
        if (running_ > 0 && limit > 0 && resident_memory() + 12 * static_cast<double>(works_[i].input_bytes) > limit)
            return false;
        queue_.erase(queue_.begin());
        const std::size_t side_by_side = std::min<std::size_t>(static_cast<std::size_t>(threads()), running_ + queue_.size() + 1);
        const int share = std::max(1, threads() / static_cast<int>(side_by_side));
        ++running_;
        Work& work = works_[i];
        work.stage = Work::Stage::running;
        work.context = std::make_unique<Context>();
        work.context->share_objects(root_);
        work.context->watch.memory_limit = limit;
        // The earlier thread of an instance that runs again may have ended without being joined.
        if (const auto before = workers_.find(i); before != workers_.end()) {
            std::erase(ended_, i);
            before->second.join();
            workers_.erase(before);
            --running_;
        }
        workers_.emplace(i, std::thread([this, i, share] { do_work(i, share); }));
        return true;
    }

    void do_work(std::size_t i, int share) {
        set_threads(share);
        InstanceState state = InstanceState::done;
        std::string problem;
        StudyRecord record;
        std::map<std::string, Object> objects;
        Context* context = nullptr;
        {
            const std::lock_guard lock(mutex_);
            record.depends = results_[i].record.depends;
            context = works_[i].context.get();
        }
        try {
            const WatchScope watched(&context->watch);
            const WriteScope written(folder_);
            make_folder(folder_of(i));
            const FolderLock lock(folder_of(i), [&] { return context->watch.is_cancelled(); });
            check_cancelled();
            if (lock.waited() && was_done_meanwhile(i, record)) return end_work(i, InstanceState::unchanged, {}, record, {});
            const Stopwatch clock;
            record.began = now_text();
            if (plan_.study.steps[instance(i).step].operation != nullptr) do_operation(i, *context, record, objects, clock);
            else do_program(i, context->watch, share, record, clock);
        } catch (const Error& error) {
            state = InstanceState::failed;
            problem = error.what();
        } catch (const std::bad_alloc&) {
            state = InstanceState::failed;
            problem = "out of memory (use --memory, fewer threads or smaller meshes)";
        } catch (const std::exception& error) {
            state = InstanceState::failed;
            problem = std::string("internal error: ") + error.what();
        }
        end_work(i, state, problem, record, objects);
    }

    void end_work(std::size_t i, InstanceState state, const std::string& problem, const StudyRecord& record,
                  const std::map<std::string, Object>& objects) {
        const std::lock_guard lock(mutex_);
        if (state == InstanceState::done || state == InstanceState::unchanged) {
            works_[i].objects = objects;
            results_[i].record = record;
        }
        results_[i].problem = problem;
        finish(i, state);
        ended_.push_back(i);
        changed_.notify_all();
    }

    /// Whether another process completed the instance while this one waited for its folder; fills the record.
    bool was_done_meanwhile(std::size_t i, StudyRecord& record) {
        const auto known = read_record(folder_of(i));
        if (!known) return false;
        for (const auto& [output, made] : known->outputs) {
            checksums_.forget(folder_of(i) / made.file);
            if (!made.kept) return false;  // exists only in the memory of the other process
        }
        if (!why_again(plan_, known, dependencies_of(i), instance(i), folder_, checksums_).empty()) return false;
        record = *known;
        return true;
    }

    /// Fails instances with an input that changed during the study, since their outputs may mix old and new content.
    void fail_changed() {
        std::set<Path> changed;
        for (const auto& [file, stamp] : stamps_)
            if (stamp_of(file) != stamp && !checksums_.is_known(file)) changed.insert(file);
        for (const Path& file : checksums_.changed())
            if (!is_inside(file, folder_)) changed.insert(file);
        if (changed.empty()) return;
        const auto is_changed = [&](const Path& file) {
            return std::any_of(changed.begin(), changed.end(),
                               [&](const Path& one) { return one == file || is_inside(one, file); });
        };
        for (std::size_t i = 0; i < works_.size(); ++i) {
            InstanceResult& result = results_[i];
            if (result.state != InstanceState::done && result.state != InstanceState::unchanged) continue;
            std::string which;
            for (const StudyInput& input : instance(i).inputs)
                if (!input.file.empty() && is_changed(input.file)) which = input.file.string();
            for (const auto& [file, sum] : result.record.read)
                if (!file.starts_with(in_run) && is_changed((plan_.study.folder / file).lexically_normal())) which = file;
            const bool is_behind = std::any_of(instance(i).needs.begin(), instance(i).needs.end(), [&](std::size_t need) {
                return results_[need].state == InstanceState::failed || results_[need].state == InstanceState::skipped;
            });
            if (which.empty() && !is_behind) continue;
            result.state = which.empty() ? InstanceState::skipped : InstanceState::failed;
            result.problem = which.empty() ? "what it takes was made of an input that changed while the study ran"
                                           : "'" + which + "' changed while the study ran (run it again)";
            if (!which.empty()) remove_file(folder_of(i) / "record.json");
        }
    }

    void do_operation(std::size_t i, Context& context, StudyRecord& record, std::map<std::string, Object>& objects,
                      const Stopwatch& clock) {
        const StudyInstance& one = instance(i);
        const Path folder = folder_of(i);
        // Output folders of a completed run are removed; those of a killed run keep the results of studies.
        if (const auto before = read_record(folder))
            for (const auto& [output, was] : before->outputs)
                if (std::error_code code; was.kept && was.is_folder) std::filesystem::remove_all(folder / was.file, code);
        Call call = plan_.call(one, [&](const StudyInput& input) { return source_of(input); });
        std::set<std::string> written;  // outputs written by the operation itself
        for (const auto& [output, file] : one.outputs) {
            Slot& slot = call.slot(output);
            const bool taken = std::any_of(works_[i].takers.begin(), works_[i].takers.end(), [&](std::size_t taker) {
                const auto& inputs = instance(taker).inputs;
                return std::any_of(inputs.begin(), inputs.end(),
                                   [&](const StudyInput& input) { return input.instance == i && input.output == output; });
            });
            if (!one.kept.contains(output) || (taken && !slot.fills_folder(0))) continue;
            slot.sources.front() = {folder / file, {}};
            written.insert(output);
        }
        const Report report = call.run(context);
        record.holds = report.holds();
        for (const auto& read : context.files_read()) {
            checksums_.know(read.file, read.sha256);
            if (is_memory(read.file) || is_own_input(one, read.file)) continue;
            const std::string in_folder = within_run(read.file);
            record.read.emplace_back(in_folder.empty() ? plan_.study.relative(read.file) : in_run + in_folder, read.sha256);
        }
        auto outputs = std::make_unique<OutputTransaction>();
        for (const auto& [output, file] : one.outputs) {
            OutputRecord& made = record.outputs[output];
            made.file = file;
            made.kept = one.kept.contains(output);
            made.is_folder = call.slot(output).fills_folder(0);
            if (written.contains(output)) continue;
            if (call.slot(output).sources.empty() || !call.slot(output).sources.front().object) {  // it was not made
                record.outputs.erase(output);
                continue;
            }
            const Object& object = call.object(output);
            if (made.kept) write_object(object, folder / file, output);
            objects.emplace(output, object);
        }
        write_json(folder / "report.json", report.to_json());
        outputs->commit();
        outputs.reset();
        for (auto& [output, made] : record.outputs) {
            const Path file = folder / made.file;
            if (made.kept) {
                checksums_.forget(file);
                if (made.is_folder ? !is_folder(file) : !file_exists(file))
                    fail_work(file.string(), "was asked for and not made", "see what '" + output + "' depends on");
                made.sha256 = made.is_folder ? FileChecksums().folder(file) : sha256_of_file(file);
            } else if (const auto known = objects.find(output); known != objects.end()) {
                const auto in_memory = known->second.as<Path>();
                made.sha256 = in_memory ? FileChecksums().folder(*in_memory) : known->second.checksums().sha256;
            }
        }
        keep(i, record, clock);
    }

    /// Whether the file is an input of the instance, or an output of another instance that it uses; the record then covers it
    /// already.
    bool is_own_input(const StudyInstance& one, const Path& file) {
        return std::any_of(one.inputs.begin(), one.inputs.end(), [&](const StudyInput& input) {
            if (input.instance == no_instance) return input.file == file;
            const std::lock_guard lock(mutex_);
            const auto& outputs = results_[input.instance].record.outputs;
            return outputs.contains(input.output) && file_of(input) == file;
        });
    }
    /// The path of a file relative to the run folder; empty for files elsewhere.
    std::string within_run(const Path& file) const {
        const auto full = [](const Path& path) { return std::filesystem::absolute(path).lexically_normal(); };
        const Path relative = full(file).lexically_relative(full(folder_));
        return relative.empty() || *relative.begin() == ".." ? std::string() : relative.generic_string();
    }

    Source source_of(const StudyInput& input) {
        const std::lock_guard lock(mutex_);
        const Work& work = works_[input.instance];
        if (const auto object = work.objects.find(input.output); !input.on_disk && object != work.objects.end()) {
            Source source{{}, object->second};
            source.object.name = results_[input.instance].record.outputs.at(input.output).file;
            return source;
        }
        return {file_of(input), {}};
    }
    Path file_of(const StudyInput& input) const {
        const auto& outputs = results_[input.instance].record.outputs;
        const auto known = outputs.find(input.output);
        if (known == outputs.end())
            fail_work(plan_.instances[input.instance].title(plan_.study), "has not made '" + input.output + "'",
                      "look at what it wrote, and name that");
        return std::filesystem::absolute(folder_of(input.instance) / known->second.file);
    }

    void do_program(std::size_t i, const Watch& watch, int share, StudyRecord& record, const Stopwatch& clock) {
        const StudyInstance& one = instance(i);
        const Path folder = std::filesystem::absolute(folder_of(i));
        empty_folder(folder);  // removes the files of an earlier run
        const auto words = plan_.words(
            one,
            [&](const StudyInput& input) {
                const std::lock_guard lock(mutex_);
                return input.instance == no_instance ? input.file : file_of(input);
            },
            folder);
        std::vector<std::string> started = words;
        started.front() =
            std::filesystem::absolute(find_program(words.front(), options_.program_folder, plan_.study.steps[one.step].name))
                .string();
        ChildProcess program(
            started, {.folder = folder, .output = folder / "output.txt", .errors = folder / "output.txt", .threads = share});
        if (!program.wait([&] { return watch.is_cancelled(); })) {
            program.signal(SIGTERM);
            const Stopwatch since;
            program.wait([&] { return since.seconds() > 0.4; });  // then it is killed
            throw Error(ErrorKind::cancelled, "", "cancelled", "nothing was written");
        }
        const int exit_code = program.code();
        if (exit_code != 0 && exit_code != 3) {
            std::string text = read_file(folder / "output.txt");
            if (text.size() > 600) text = "..." + text.substr(text.size() - 600);
            fail_work(words.front(), program.ending() + ": " + printable(std::string(trimmed(text)), 700),
                      "see " + (folder / "output.txt").string());
        }
        record.holds = exit_code == 0;
        for (std::filesystem::recursive_directory_iterator entry(folder), end; entry != end; ++entry) {
            if (!entry->is_regular_file()) continue;
            const std::string name = entry->path().lexically_relative(folder).generic_string();
            record.outputs[name] = {name, sha256_of_file(entry->path()), true, false};
            checksums_.forget(folder_of(i) / name);
        }
        Json report(rapidjson::kObjectType);
        auto& allocator = report.GetAllocator();
        add_members(report, allocator, "format", "ostraka-report", "command", words.front(), "result",
                    json_object(allocator, "holds", record.holds));
        write_json(folder / "report.json", report);
        keep(i, record, clock);
    }

    /// Writes the record last: without it the instance runs again.
    void keep(std::size_t i, StudyRecord& record, const Stopwatch& clock) {
        const Path folder = folder_of(i);
        const auto before = read_record(folder);
        if (record.depends.empty()) record.depends = dependencies_of(i);
        record.seconds = clock.seconds();
        record.ended = now_text();
        write_record(folder, plan_, instance(i), record);
        if (!before) return;
        for (const auto& [output, was] : before->outputs) {  // remove outputs of the earlier run that now have other names
            const bool again = std::any_of(record.outputs.begin(), record.outputs.end(),
                                           [&](const auto& made) { return made.second.kept && made.second.file == was.file; });
            if (was.kept && !again && !was.is_folder && file_exists(folder / was.file)) remove_file(folder / was.file);
        }
    }

    void join_ended(std::unique_lock<std::mutex>& lock) {
        while (!ended_.empty()) {
            const auto worker = workers_.find(ended_.back());
            ended_.pop_back();
            std::thread thread = std::move(worker->second);
            workers_.erase(worker);
            lock.unlock();
            thread.join();
            lock.lock();
            --running_;
        }
    }

    void tell(const Watch& watch) {
        if (!watch.on_progress || selected_ == 0) return;
        double known = 0, left = 0;
        std::size_t count = 0, open = 0;
        for (std::size_t i = 0; i < works_.size(); ++i) {
            if (results_[i].state == InstanceState::done) known += results_[i].record.seconds, ++count;
            if (works_[i].selected && works_[i].stage != Work::Stage::final) ++open;
        }
        const double mean = count > 0 ? known / static_cast<double>(count) : -1;
        bool certain = true;
        for (const Work& work : works_)
            if (work.selected && work.stage != Work::Stage::final) {
                const double seconds = work.expected >= 0 ? work.expected : mean;
                certain = certain && seconds >= 0;
                left += std::max(0.0, seconds);
            }
        left /= static_cast<double>(std::max<std::size_t>(1, std::min<std::size_t>(static_cast<std::size_t>(threads()), open)));
        std::string phase;
        for (const auto& [i, thread] : workers_) phase += (phase.empty() ? "" : ", ") + instance(i).title(plan_.study);
        phase += ": " + std::to_string(finished_) + " of " + std::to_string(selected_);
        if (certain && open > 0)
            phase += left < 90 ? ", " + std::to_string(static_cast<int>(left) + 1) + " s left"
                               : ", " + std::to_string(static_cast<int>(left / 60) + 1) + " min left";
        watch.on_progress(phase, std::min(0.999, static_cast<double>(finished_) / static_cast<double>(selected_)));
    }

    const StudyPlan& plan_;
    const Path folder_;
    const RunStudyOptions& options_;
    std::vector<Work> works_;
    std::vector<InstanceResult> results_;
    FileChecksums checksums_;
    Context root_;  ///< caches objects read from files as long as an instance may need them
    std::map<Path, std::size_t> file_uses_;
    std::map<Path, std::optional<FileStamp>> stamps_;  ///< stamps of the inputs at the start of the run
    std::set<std::size_t> to_consider_;
    std::vector<std::size_t> queue_, ended_;
    std::map<std::size_t, std::thread> workers_;
    std::size_t running_ = 0, finished_ = 0, selected_ = 0;
    std::mutex mutex_;
    std::condition_variable changed_;
};

}  // namespace

std::string to_string(InstanceState state) {
    static constexpr const char* names[]{"left out", "unchanged", "would run", "done", "failed", "skipped"};
    return names[static_cast<std::size_t>(state)];
}

std::vector<InstanceResult> run_study(const StudyPlan& plan, const Path& folder, const RunStudyOptions& options) {
    for (const std::string& name : options.only)
        if (plan.study.step(name) == plan.study.steps.size())
            fail_usage("--only names '" + printable(name, 60) + "', which is no step of " + plan.study.file.string(),
                       "its steps: " + joined(plan.study.steps, ", ", &StudyStep::name));
    check_run_folder(plan, folder);
    return Runner(plan, folder, options).run();
}

}  // namespace ostraka
