#include "ostraka/workflow/run.h"

#include "workflow/run_folder.h"

#include "ostraka/core/memory.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/stopwatch.h"
#include "ostraka/execution/child_process.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/files/json_build.h"
#include "ostraka/files/safe_path.h"
#include "ostraka/files/transaction.h"
#include "ostraka/framework/object_files.h"

#include <fmt/core.h>

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
    bool must_rerun = false;              ///< runs although it is done: its outputs are needed in memory
    std::size_t open_needs = 0;           ///< number of unfinished instances that it needs
    std::size_t open_dependents = 0;      ///< number of unfinished instances that need it
    std::vector<std::size_t> dependents;  ///< instances that need it
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
                works_[need].dependents.push_back(i);
                ++works_[need].open_dependents;
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
            report_progress(*watch);
        }
        join_ended(lock);
        if (cancelled)
            throw Error(ErrorKind::cancelled, "", "cancelled", "completed steps are kept: the same command resumes the run");
        if (!options_.dry_run) fail_changed();
        return std::move(results_);
    }

private:
    const StudyInstance& instance(std::size_t i) const { return plan_.instances[i]; }
    Path folder_of(std::size_t i) const { return folder_ / instance(i).folder; }

    /// Selects the requested instances and their dependencies.
    void select() {
        std::vector<std::size_t> pending;
        std::vector<bool> has_dependents(works_.size(), false);
        for (const StudyInstance& step_instance : plan_.instances)
            for (const std::size_t need : step_instance.needs) has_dependents[need] = true;
        for (std::size_t i = 0, leaf = 0; i < works_.size(); ++i) {
            const std::string& name = plan_.study.steps[instance(i).step].name;
            if (!options_.only.empty() && std::find(options_.only.begin(), options_.only.end(), name) == options_.only.end())
                continue;
            if (!options_.share.is_whole() && (has_dependents[i] || !options_.share.has(leaf++))) continue;
            pending.push_back(i);
        }
        while (!pending.empty()) {
            const std::size_t i = pending.back();
            pending.pop_back();
            if (works_[i].selected) continue;
            works_[i].selected = true;
            pending.insert(pending.end(), instance(i).needs.begin(), instance(i).needs.end());
        }
    }

    bool is_there(std::size_t i, const std::string& output) const {
        const Work& work = works_[i];
        if (work.objects.contains(output)) return true;
        const auto& outputs = results_[i].record.outputs;
        const auto recorded = outputs.find(output);
        return recorded != outputs.end() && recorded->second.kept;
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
                result.why = fmt::format("it uses outputs of {}, which would run", plan_.instances[need].title(plan_.study));
                return finish(i, InstanceState::would_run);
            }
        }
        if (!work.must_rerun) {
            try {
                lock.unlock();  // checksums of large files take time
                const auto record = read_record(folder_of(i));
                // Without a record, files are read by the instances that need them, which also yields their checksums.
                std::vector<std::pair<std::string, std::string>> depends;
                if (record) depends = dependencies_of(i);
                std::string why = rerun_reason(plan_, record, depends, instance(i), folder_, checksums_);
                if (why.empty() && options_.rerun_all) why = "all steps were requested to run again (--again)";
                lock.lock();
                if (record) work.expected = record->seconds;
                if (why.empty()) {
                    result.record = *record;
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
            other.must_rerun = true;
            // Keep its inputs until it has run again.
            for (const std::size_t need : instance(input.instance).needs) ++works_[need].open_dependents;
            results_[input.instance].why = "its outputs are needed again by " + instance(i).title(plan_.study);
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
        const bool first = !work.must_rerun;
        work.must_rerun = false;
        work.stage = Work::Stage::final;
        results_[i].state = state;
        if (first) {
            ++finished_;
            for (const StudyInput& input : instance(i).inputs)
                if (!input.file.empty() && --file_uses_[input.file] == 0) root_.forget(input.file);
        }
        for (const std::size_t need : instance(i).needs) {
            if (--works_[need].open_dependents == 0) release(need);
        }
        if (work.open_dependents == 0) release(i);
        else if (state != InstanceState::done) works_[i].context.reset();
        for (const std::size_t dependent : work.dependents) {
            if (first) --works_[dependent].open_needs;
            if (works_[dependent].open_needs == 0 && works_[dependent].stage == Work::Stage::waiting)
                to_consider_.insert(dependent);
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
        const int thread_count = std::max(1, threads() / static_cast<int>(side_by_side));
        ++running_;
        Work& work = works_[i];
        work.stage = Work::Stage::running;
        work.context = std::make_unique<Context>();
        work.context->share_objects(root_);
        work.context->watch.memory_limit = limit;
        // The earlier thread of an instance that runs again may have ended without being joined.
        if (const auto earlier_thread = workers_.find(i); earlier_thread != workers_.end()) {
            std::erase(ended_, i);
            earlier_thread->second.join();
            workers_.erase(earlier_thread);
            --running_;
        }
        workers_.emplace(i, std::thread([this, i, thread_count] { do_work(i, thread_count); }));
        return true;
    }

    void do_work(std::size_t i, int thread_count) {
        set_threads(thread_count);
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
            else do_program(i, context->watch, thread_count, record, clock);
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
        const auto recorded = read_record(folder_of(i));
        if (!recorded) return false;
        for (const auto& [output, recorded_output] : recorded->outputs) {
            checksums_.forget(folder_of(i) / recorded_output.file);
            if (!recorded_output.kept) return false;  // exists only in the memory of the other process
        }
        if (!rerun_reason(plan_, recorded, dependencies_of(i), instance(i), folder_, checksums_).empty()) return false;
        record = *recorded;
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
                               [&](const Path& changed_path) { return changed_path == file || is_inside(changed_path, file); });
        };
        for (std::size_t i = 0; i < works_.size(); ++i) {
            InstanceResult& result = results_[i];
            if (result.state != InstanceState::done && result.state != InstanceState::unchanged) continue;
            std::string changed_input;
            for (const StudyInput& input : instance(i).inputs)
                if (!input.file.empty() && is_changed(input.file)) changed_input = input.file.string();
            for (const auto& [file, checksum] : result.record.read)
                if (!file.starts_with(run_folder_prefix) && is_changed((plan_.study.folder / file).lexically_normal()))
                    changed_input = file;
            const bool depends_on_failure =
                std::any_of(instance(i).needs.begin(), instance(i).needs.end(), [&](std::size_t need) {
                    return results_[need].state == InstanceState::failed || results_[need].state == InstanceState::skipped;
                });
            if (changed_input.empty() && !depends_on_failure) continue;
            result.state = changed_input.empty() ? InstanceState::skipped : InstanceState::failed;
            result.problem = changed_input.empty()
                                 ? "it depends on an input that changed while the study ran"
                                 : fmt::format("'{}' changed while the study ran (run it again)", changed_input);
            if (!changed_input.empty()) remove_file(folder_of(i) / "record.json");
        }
    }

    void do_operation(std::size_t i, Context& context, StudyRecord& record, std::map<std::string, Object>& objects,
                      const Stopwatch& clock) {
        const StudyInstance& operation_instance = instance(i);
        const Path folder = folder_of(i);
        // Output folders of a completed run are removed; those of a killed run keep the results of studies.
        if (const auto earlier_record = read_record(folder))
            for (const auto& [output, was] : earlier_record->outputs)
                if (std::error_code code; was.kept && was.is_folder) std::filesystem::remove_all(folder / was.file, code);
        Call call = plan_.call(operation_instance, [&](const StudyInput& input) { return source_of(input); });
        std::set<std::string> written;  // outputs written by the operation itself
        for (const auto& [output, file] : operation_instance.outputs) {
            Slot& slot = call.slot(output);
            const bool is_used =
                std::any_of(works_[i].dependents.begin(), works_[i].dependents.end(), [&](std::size_t dependent) {
                    const auto& inputs = instance(dependent).inputs;
                    return std::any_of(inputs.begin(), inputs.end(),
                                       [&](const StudyInput& input) { return input.instance == i && input.output == output; });
                });
            if (!operation_instance.kept.contains(output) || (is_used && !slot.fills_folder(0))) continue;
            slot.sources.front() = {folder / file, {}};
            written.insert(output);
        }
        const Report report = call.run(context);
        record.holds = report.holds();
        for (const auto& read : context.files_read()) {
            checksums_.store(read.file, read.sha256);
            if (is_memory(read.file) || is_recorded_input(operation_instance, read.file)) continue;
            const std::string path_in_run_folder = relative_to_run(read.file);
            record.read.emplace_back(
                path_in_run_folder.empty() ? plan_.study.relative(read.file) : run_folder_prefix + path_in_run_folder,
                read.sha256);
        }
        auto outputs = std::make_unique<OutputTransaction>();
        for (const auto& [output, file] : operation_instance.outputs) {
            OutputRecord& output_record = record.outputs[output];
            output_record.file = file;
            output_record.kept = operation_instance.kept.contains(output);
            output_record.is_folder = call.slot(output).fills_folder(0);
            if (written.contains(output)) continue;
            if (call.slot(output).sources.empty() || !call.slot(output).sources.front().object) {  // it was not made
                record.outputs.erase(output);
                continue;
            }
            const Object& object = call.object(output);
            if (output_record.kept) write_object(object, folder / file, output);
            objects.emplace(output, object);
        }
        write_json(folder / "report.json", report.to_json());
        outputs->commit();
        outputs.reset();
        for (auto& [output, output_record] : record.outputs) {
            const Path file = folder / output_record.file;
            if (output_record.kept) {
                checksums_.forget(file);
                if (output_record.is_folder ? !is_folder(file) : !file_exists(file))
                    fail_work(file.string(), "was requested but not produced",
                              fmt::format("check the inputs and options that '{}' depends on", output));
                output_record.sha256 = output_record.is_folder ? FileChecksums().folder(file) : sha256_of_file(file);
            } else if (const auto object = objects.find(output); object != objects.end()) {
                const auto in_memory = object->second.as<Path>();
                output_record.sha256 = in_memory ? FileChecksums().folder(*in_memory) : object->second.checksums().sha256;
            }
        }
        keep(i, record, clock);
    }

    /// Whether the file is an input of the instance, or an output of another instance that it uses; the record then covers it
    /// already.
    bool is_recorded_input(const StudyInstance& user, const Path& file) {
        return std::any_of(user.inputs.begin(), user.inputs.end(), [&](const StudyInput& input) {
            if (input.instance == no_instance) return input.file == file;
            const std::lock_guard lock(mutex_);
            const auto& outputs = results_[input.instance].record.outputs;
            return outputs.contains(input.output) && file_of(input) == file;
        });
    }
    /// The path of a file relative to the run folder; empty for files elsewhere.
    std::string relative_to_run(const Path& file) const {
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
        const auto output = outputs.find(input.output);
        if (output == outputs.end())
            fail_work(plan_.instances[input.instance].title(plan_.study), fmt::format("did not produce '{}'", input.output),
                      "name one of the files that it wrote");
        return std::filesystem::absolute(folder_of(input.instance) / output->second.file);
    }

    void do_program(std::size_t i, const Watch& watch, int thread_count, StudyRecord& record, const Stopwatch& clock) {
        const StudyInstance& program_instance = instance(i);
        const Path folder = std::filesystem::absolute(folder_of(i));
        empty_folder(folder);  // removes the files of an earlier run
        const auto words = plan_.words(
            program_instance,
            [&](const StudyInput& input) {
                const std::lock_guard lock(mutex_);
                return input.instance == no_instance ? input.file : file_of(input);
            },
            folder);
        std::vector<std::string> started = words;
        started.front() = std::filesystem::absolute(
                              find_program(words.front(), options_.program_folder, plan_.study.steps[program_instance.step].name))
                              .string();
        ChildProcess program(
            started,
            {.folder = folder, .output = folder / "output.txt", .errors = folder / "output.txt", .threads = thread_count});
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
            fail_work(words.front(), fmt::format("{}: {}", program.ending(), printable(std::string(trimmed(text)), 700)),
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
        const auto earlier_record = read_record(folder);
        if (record.depends.empty()) record.depends = dependencies_of(i);
        record.seconds = clock.seconds();
        record.ended = now_text();
        write_record(folder, plan_, instance(i), record);
        if (!earlier_record) return;
        for (const auto& [output, was] :
             earlier_record->outputs) {  // remove outputs of the earlier run that now have other names
            const bool is_kept_again = std::any_of(record.outputs.begin(), record.outputs.end(), [&](const auto& new_output) {
                return new_output.second.kept && new_output.second.file == was.file;
            });
            if (was.kept && !is_kept_again && !was.is_folder && file_exists(folder / was.file)) remove_file(folder / was.file);
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

    void report_progress(const Watch& watch) {
        if (!watch.on_progress || selected_ == 0) return;
        double seconds_done = 0, seconds_left = 0;
        std::size_t count = 0, open = 0;
        for (std::size_t i = 0; i < works_.size(); ++i) {
            if (results_[i].state == InstanceState::done) seconds_done += results_[i].record.seconds, ++count;
            if (works_[i].selected && works_[i].stage != Work::Stage::final) ++open;
        }
        const double mean = count > 0 ? seconds_done / static_cast<double>(count) : -1;
        bool certain = true;
        for (const Work& work : works_)
            if (work.selected && work.stage != Work::Stage::final) {
                const double seconds = work.expected >= 0 ? work.expected : mean;
                certain = certain && seconds >= 0;
                seconds_left += std::max(0.0, seconds);
            }
        seconds_left /=
            static_cast<double>(std::max<std::size_t>(1, std::min<std::size_t>(static_cast<std::size_t>(threads()), open)));
        std::string phase;
        for (const auto& [i, thread] : workers_) phase += (phase.empty() ? "" : ", ") + instance(i).title(plan_.study);
        phase += fmt::format(": {} of {}", finished_, selected_);
        if (certain && open > 0)
            phase += seconds_left < 90 ? fmt::format(", {} s left", static_cast<int>(seconds_left) + 1)
                                       : fmt::format(", {} min left", static_cast<int>(seconds_left / 60) + 1);
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
            fail_usage(fmt::format("--only names '{}', which is not a step of {}", printable(name, 60), plan.study.file.string()),
                       "its steps: " + joined(plan.study.steps, ", ", &StudyStep::name));
    check_run_folder(plan, folder);
    return Runner(plan, folder, options).run();
}

}  // namespace ostraka
